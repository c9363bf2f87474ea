#pragma once

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/scan_points.hpp"
#include "mapping/wall_map/distance_field.hpp"

namespace madori::localization {

struct BeamPathOptions {
  double end_margin_m = 0.4;  ///< of the beam before its end point, where its own wall may lie
  std::size_t most_beams = 64;
};

/// Share of the beams (0..1, by weight) that would have to pass through a drawn wall to reach their end
/// points: near zero at the true pose unless walls are missing, large where a pose lies behind a wall. Walks
/// each beam by the distance field's own distances. At most `most_beams` beams, evenly spread.
[[nodiscard]] double share_through_walls(const ScanPoints& points, const mapping::DistanceField& field,
                                         const Transform2<Map, Base>& map_from_base,
                                         const BeamPathOptions& options = {});

}  // namespace madori::localization
