#pragma once

#include <vector>

#include "mapping/drawing/vector/dxf_lines.hpp"

namespace madori::mapping {

/// Marks the lines that lie like the leaf of a door: from the middle of a quarter arc to one of its ends,
/// drawn as one line or as a thin rectangle. Arcs much larger or smaller than most are no doors.
void mark_door_leaves(std::vector<DxfLine>& lines, const std::vector<DoorSwing>& swings);

/// The same for doors drawn ajar, by shorter arcs: an arc without a leaf stays what it is, one with a leaf is
/// marked with it.
void mark_doors_ajar(std::vector<DxfLine>& lines, const std::vector<DoorSwing>& arcs);

}  // namespace madori::mapping
