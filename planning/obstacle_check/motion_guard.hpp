#pragma once

#include <vector>

#include "core/velocity_command.hpp"
#include "planning/obstacle_check/path_check.hpp"

namespace madori::planning {

struct GuardOptions {
  double body_margin_m = 0.02;  ///< around the outline, to what is seen
  double wall_margin_m = 0.01;  ///< ... to drawn walls
  double step_m = 0.005;        ///< least way of the outline's furthest corner between two checked poses
};

/// The clearance law: the share of a command, 0 to 1, with which the vehicle could still brake before its
/// outline comes nearer to any obstacle than the margin; nearer than half of what is left to one that is
/// within the margin already; deeper over one that is inside. Each obstacle is judged for itself: being near
/// one, or in one, never lets the vehicle nearer to another. path_check looks at the path, this at what the
/// vehicle really does beside it. Speeds are scaled together, so that the curve stays.
[[nodiscard]] double guarded_share(const Transform2<Map, Base>& map_from_base, const VelocityCommand& command,
                                   const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                                   const VehicleOutline& vehicle, const BrakingModel& braking,
                                   const GuardOptions& options = {});

}  // namespace madori::planning
