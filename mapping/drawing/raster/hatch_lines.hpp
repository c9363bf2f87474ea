#pragma once

#include <vector>

#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/wall_evidence.hpp"

namespace madori::mapping {

/// Rejects stairs, hatched areas, tiles and gratings: four or more parallel lines of like length, side by
/// side at even, small distances. Wall faces come in pairs, their distances alternate; faces with
/// hatching or a fill between them are kept.
void reject_hatch(DrawnLines& lines, const std::vector<Evidence>& evidence);

}  // namespace madori::mapping
