#pragma once

#include "planning/waypoints/waypoints.hpp"

namespace madori::test {

/// Along the x axis from the origin.
[[nodiscard]] inline Path straight_way(double length_m) {
  return planning::make_waypoints({{{0, 0}}, {{length_m, 0}}}).value();
}

}  // namespace madori::test
