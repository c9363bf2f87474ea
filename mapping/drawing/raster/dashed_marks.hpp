#pragma once

#include <vector>

#include "mapping/drawing/raster/components.hpp"

namespace madori::mapping {

/// Dashed and dash-dot lines: separate straight bars of like thickness, one after the other on one line with
/// even gaps (after D. Dori, L. Wenyin, "Stepwise recovery of dashed lines", PAMI 1999). Returns the marks of
/// each. A wall broken by doors is none: its gaps are wide for its thickness and uneven.
[[nodiscard]] std::vector<std::vector<std::size_t>> find_dashed(const Components& marks, double pen_px);

}  // namespace madori::mapping
