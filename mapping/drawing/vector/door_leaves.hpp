#pragma once

#include <vector>

#include "mapping/drawing/vector/dxf_lines.hpp"

namespace madori::mapping {

/// Marks the lines that lie like the leaf of a door: from the middle of a quarter arc to one of its ends,
/// drawn as one line or as a thin rectangle. Arcs much larger or smaller than most are no doors.
void mark_door_leaves(std::vector<DxfLine>& lines, const std::vector<DoorSwing>& swings);

}  // namespace madori::mapping
