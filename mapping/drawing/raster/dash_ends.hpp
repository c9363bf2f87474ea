#pragma once

#include <vector>

#include "mapping/drawing/raster/components.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

/// The axis of every dash of the dashed lines that were found; `chain` numbers the dashed line.
[[nodiscard]] DrawnLines dash_axes(const Components& marks,
                                   const std::vector<std::vector<std::size_t>>& dashed);

/// Rejects what goes on where a dashed line stops being separate bars: bent dashes, corners, the last dash
/// that touches a wall. Lines of like thickness that continue a dash after a gap like the others.
void reject_dash_ends(DrawnLines& lines, const DrawnLines& dashes);

}  // namespace madori::mapping
