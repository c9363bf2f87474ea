#pragma once

#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::hmi {

/// Drawn wall that the vehicle does not count on any more, because its lidar looks through where it is drawn:
/// a person is asked whether it is gone for good.
struct DoubtedWall {
  std::vector<Segment2<Map>> segments;  ///< the longest first; the others are faces of the same wall
  double missed = 0.0;                  ///< looks through it, of the piece with the fewest
};

/// Adjoining pieces of a wall together, both faces of a wall together; the longest first. `standing`:
/// stretches of which a person has said that they are still there; pieces on them are left out.
[[nodiscard]] std::vector<DoubtedWall> doubted_walls(const std::vector<WallView>& pieces,
                                                     const std::vector<Segment2<Map>>& standing);

}  // namespace madori::hmi
