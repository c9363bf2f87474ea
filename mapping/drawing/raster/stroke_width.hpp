#pragma once

#include "mapping/drawing/gray_image.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

/// Sets `stroke_px` of every line: the median thickness of the ink across it, at places all along.
void measure_strokes(DrawnLines& lines, const GrayImage& ink);

}  // namespace madori::mapping
