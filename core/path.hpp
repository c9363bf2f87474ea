#pragma once

#include <limits>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori {

/// A waypoint of a path that the vehicle's Base origin shall follow.
struct PathPoint {
  Point2<Map> position;
  double heading_rad = 0.0;      ///< direction of travel, Map frame
  double curvature_per_m = 0.0;  ///< positive turns left
  double speed_limit_mps = std::numeric_limits<double>::infinity();
};

struct Path {
  std::vector<PathPoint> points;
};

}  // namespace madori
