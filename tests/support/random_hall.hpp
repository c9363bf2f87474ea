#pragma once

#include <random>
#include <vector>

#include "core/point2.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::test {

/// A made-up hall and a way through it. Map frame, metres.
struct RandomHall {
  double area_m2 = 0.0;
  mapping::Walls walls;
  /// Corners of a way that keeps 0.5 m from every wall: a round past places all over the hall, back to where
  /// it began, and its first third once more.
  std::vector<Point2<Map>> way;
};

/// Machines of 0.5 to 5 m, one for 30 m² or so (one in six stands askew), columns, walls with a door;
/// deterministic in `engine`.
[[nodiscard]] RandomHall random_hall(double area_m2, std::mt19937& engine);

}  // namespace madori::test
