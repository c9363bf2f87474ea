#pragma once

#include <vector>

#include "mapping/drawing/gray_image.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

struct RefineOptions {
  double shortest_px = 8;
  double largest_gap_px = 3;       ///< a line goes on over a gap up to this
  double least_fresh_share = 0.5;  ///< of a line's pixels that no earlier line took
};

/// Turns Hough seeds into lines of sub-pixel precision: follows the pixels of the line picture from the seed
/// both ways, fits by total least squares, follows again with the better direction until the line grows no
/// more. The pixels of a line are marked kTaken in `lines`, so that each is explained once.
[[nodiscard]] DrawnLines refine_lines(GrayImage& lines, const std::vector<PixelSegment>& seeds,
                                      const RefineOptions& options);

}  // namespace madori::mapping
