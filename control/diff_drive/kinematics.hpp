#pragma once

#include "core/velocity_command.hpp"
#include "core/wheels.hpp"

namespace madori::control {

struct WheelSpeeds {
  double left_radps = 0.0;
  double right_radps = 0.0;

  friend bool operator==(const WheelSpeeds&, const WheelSpeeds&) = default;
};

/// Of the wheels' rims over the floor, positive drives forward.
struct RimSpeeds {
  double left_mps = 0.0;
  double right_mps = 0.0;
};

/// Eq. (4) of the layout-map paper solved for the wheels; with d half the wheel separation, v_R - v_L = 2 d
/// omega.
[[nodiscard]] inline RimSpeeds rim_speeds(double half_separation_m, const VelocityCommand& command) {
  const double difference_mps = half_separation_m * command.angular_radps;
  return {command.linear_mps - difference_mps, command.linear_mps + difference_mps};
}

[[nodiscard]] inline WheelSpeeds wheel_speeds(const WheelGeometry& wheels, const VelocityCommand& command) {
  const RimSpeeds rims = rim_speeds(wheels.half_separation_m, command);
  return {rims.left_mps / wheels.left_radius_m, rims.right_mps / wheels.right_radius_m};
}

/// Eq. (4): what the vehicle does while its wheels turn so.
[[nodiscard]] inline VelocityCommand vehicle_velocity(const WheelGeometry& wheels,
                                                      const WheelSpeeds& speeds) {
  const double left_mps = wheels.left_radius_m * speeds.left_radps;
  const double right_mps = wheels.right_radius_m * speeds.right_radps;
  return {(right_mps + left_mps) / 2.0, (right_mps - left_mps) / (2.0 * wheels.half_separation_m)};
}

}  // namespace madori::control
