#pragma once

#include <vector>

#include "core/velocity_command.hpp"
#include "planning/obstacle_check/path_check.hpp"

namespace madori::planning {

struct GuardOptions {
  double body_margin_m = 0.02;  ///< around the outline, to what is seen
  double wall_margin_m = 0.01;  ///< ... to drawn walls
  double turn_deceleration_radps2 = 1.5;
  double step_m = 0.04;  ///< of the outline's furthest corner between two checked poses
};

/// The share of a command, 0 to 1, with which the vehicle still could stop before its outline meets
/// something, if it went on driving like this: path_check looks at the path, this at what the vehicle really
/// does beside it. Speeds are scaled together, so that the curve stays. A vehicle that stands within the
/// margins may move as far as it gets no nearer.
[[nodiscard]] double guarded_share(const Transform2<Map, Base>& map_from_base, const VelocityCommand& command,
                                   const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                                   const VehicleOutline& vehicle, const BrakingModel& braking,
                                   const GuardOptions& options = {});

}  // namespace madori::planning
