#pragma once

#include <optional>

#include "mapping/drawing/gray_image.hpp"
#include "mapping/drawing/raster/components.hpp"

namespace madori::mapping {

/// The width of the thin pen: the commonest length of ink runs across and down, pixels.
[[nodiscard]] double pen_width_px(const GrayImage& ink, const Components& marks);

/// Ink split by thickness: walls drawn as solid fills, and lines drawn with a pen.
struct Strokes {
  GrayImage solid;  ///< 255 where the ink is at least `solid_from_px` thick
  GrayImage thin;   ///< 255 on the rest of the ink
  double solid_from_px = 0;
};

/// A disc-like opening (box, then diamond) of the ink. Without `solid_from_px` 2.5 pens, at least 7 pixels.
[[nodiscard]] Strokes split_strokes(const GrayImage& ink, double pen_px, std::optional<double> solid_from_px);

}  // namespace madori::mapping
