#pragma once

#include <limits>
#include <vector>

#include "core/angle.hpp"
#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori {

/// A waypoint of a path that the vehicle's Base origin shall follow.
struct PathPoint {
  Point2<Map> position;
  double heading_rad = 0.0;      ///< direction of travel, Map frame
  double curvature_per_m = 0.0;  ///< positive turns left
  double speed_limit_mps = std::numeric_limits<double>::infinity();
  bool reverse = false;  ///< driven backward: the vehicle faces against the direction of travel

  /// Where the vehicle's front points, Map frame.
  [[nodiscard]] double facing_rad() const { return reverse ? wrap_angle(heading_rad + kPi) : heading_rad; }
};

struct Path {
  std::vector<PathPoint> points;
};

}  // namespace madori
