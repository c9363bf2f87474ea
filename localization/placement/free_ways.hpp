#pragma once

#include <vector>

#include "core/point2.hpp"
#include "localization/drawing_fit/wall_index.hpp"
#include "localization/memory/memory.hpp"
#include "mapping/wall_map/distance_field.hpp"

namespace madori::localization {

/// Where nothing stood: beams up to shortly before what they met, and the ways that were driven.
struct FreeWays {
  std::vector<Segment2<Map>> beams;
  std::vector<Segment2<Map>> driven;
};

/// Of the whole memory, beams spread evenly over keyframes and directions; frame of the memory's poses.
[[nodiscard]] FreeWays free_ways(const Memory& memory);

/// Nats against a place, of the drawn walls, in pieces of two metres, that free ways contradict after
/// `correction`: a beam or a drive came from well before the wall and went on well behind it. Pieces that
/// many ways cross count once, and a line that may be none (`walls` has its probability) counts the less.
[[nodiscard]] double nats_of_crossed_walls(const FreeWays& ways, const Transform2<Map, Map>& correction,
                                           const mapping::DistanceField& drawn, const WallIndex& walls);

}  // namespace madori::localization
