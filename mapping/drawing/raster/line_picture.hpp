#pragma once

#include <cstdint>

#include "mapping/drawing/raster/strokes.hpp"

namespace madori::mapping {

/// What a pixel of the line picture stands for; a taken pixel already belongs to a line.
enum LinePixel : std::uint8_t { kNoLine = 0, kPenLine = 1, kSolidFace = 2, kTaken = 128 };

/// A picture one pixel wide everywhere: middles of pen strokes and outlines of solid fills.
/// Values are LinePixel, pixel for pixel of the ink. Consumes the strokes' thin picture.
[[nodiscard]] GrayImage line_picture(Strokes& strokes);

}  // namespace madori::mapping
