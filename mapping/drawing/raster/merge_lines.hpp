#pragma once

#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

/// Joins collinear pieces of one kind that overlap or have no larger gap between them, until nothing changes.
/// The two faces of a wall stay two.
[[nodiscard]] DrawnLines merge_lines(DrawnLines lines, double largest_gap_px);

}  // namespace madori::mapping
