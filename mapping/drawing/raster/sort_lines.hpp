#pragma once

#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/wall_evidence.hpp"

namespace madori::mapping {

/// Decides which lines are walls: filled and paired faces first, then what is long, then what hangs between
/// walls already found. Everything else gets a reason in `rejected`.
void sort_lines(DrawnLines& lines, const std::vector<Evidence>& evidence, const WallStyle& style);

}  // namespace madori::mapping
