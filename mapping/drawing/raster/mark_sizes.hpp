#pragma once

#include <vector>

#include "mapping/drawing/raster/components.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/wall_evidence.hpp"

namespace madori::mapping {

/// Which lines belong to a small separate mark beside one dominating structure: chairs, tables, symbols. A
/// bar of wall thickness and a filled rectangle (a column) are no furniture. All false where no mark
/// dominates.
[[nodiscard]] std::vector<bool> on_small_marks(const DrawnLines& lines, const Components& marks,
                                               const WallStyle& style);

}  // namespace madori::mapping
