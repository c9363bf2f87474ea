#pragma once

#include <vector>

#include "mapping/drawing/gray_image.hpp"
#include "mapping/drawing/pixel_segment.hpp"

namespace madori::mapping {

/// Straight pieces of the line picture by the progressive probabilistic Hough transform (J. Matas, C.
/// Galambos, J. Kittler, CVIU 78, 2000; OpenCV's HoughLinesP), tile by tile: the accumulator stays in the
/// cache, one degree is enough within a tile, and empty tiles cost nothing. Good to about a pixel, longest
/// first.
[[nodiscard]] std::vector<PixelSegment> hough_seeds(const GrayImage& lines, double shortest_px);

}  // namespace madori::mapping
