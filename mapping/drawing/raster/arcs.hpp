#pragma once

#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/wall_evidence.hpp"

namespace madori::mapping {

/// Rejects door swings (arcs of about a quarter turn and small radius, without a second arc beside them) and
/// small circles. Curved walls have a second face or a large radius, and stay.
void reject_arcs(DrawnLines& lines, const std::vector<Evidence>& evidence, const WallStyle& style);

}  // namespace madori::mapping
