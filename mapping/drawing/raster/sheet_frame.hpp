#pragma once

#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/wall_evidence.hpp"

namespace madori::mapping {

/// Rejects the border of the sheet: long single lines with nothing of the drawing beyond them and next to
/// nothing attached to them. The outline of a building carries its inner walls.
void reject_frame(DrawnLines& lines, const std::vector<Evidence>& evidence, const WallStyle& style);

}  // namespace madori::mapping
