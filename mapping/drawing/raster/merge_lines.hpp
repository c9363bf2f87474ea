#pragma once

#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

struct MergeOptions {
  double largest_gap_px = 4;       ///< pieces of one line further apart stay apart: a door is no gap
  double largest_offset_px = 1.5;  ///< sideways, between pieces of one line
  double largest_angle_rad = 0.035;
};

/// Joins collinear pieces of one kind that overlap or nearly touch, until nothing changes. Two faces of a
/// wall are further apart than the offset and stay two.
[[nodiscard]] DrawnLines merge_lines(DrawnLines lines, const MergeOptions& options);

}  // namespace madori::mapping
