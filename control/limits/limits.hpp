#pragma once

#include <limits>

#include "core/velocity_command.hpp"

namespace madori::control {

/// What the drive can and may do. All values positive.
struct LimitOptions {
  double max_speed_mps = 1.0;
  double max_turn_rate_radps = 1.0;
  double max_wheel_speed_mps = 1.3;
  double half_wheel_separation_m = 0.25;
  double acceleration_mps2 = 0.5;
  double turn_acceleration_radps2 = 1.5;
  double jerk_mps3 = 2.0;  ///< how fast the acceleration itself may grow
};

/// What is remembered between two steps.
struct LimitState {
  VelocityCommand previous;
  double acceleration_mps2 = 0.0;  ///< of the previous step; zero while the speed fell

  friend bool operator==(const LimitState&, const LimitState&) = default;
};

struct LimitInput {
  VelocityCommand requested;
  bool may_move = true;  ///< false: emergency stop, protective field, lost, old data
  double speed_cap_mps = std::numeric_limits<double>::infinity();  ///< by the free distance, right now
  double step_s;                                                   ///< since the previous command
};

struct LimitOutput {
  LimitState state;
  VelocityCommand command;
};

/// The last stage before the drive. It can only lower a speed: the command's linear and angular parts never
/// exceed the request's in magnitude and never turn its sign, and a request within all limits passes
/// unchanged. Slowing down is therefore never limited here; smooth braking belongs to the stages before. A
/// request that is not finite, or a step time that is not positive, stops the vehicle.
[[nodiscard]] LimitOutput limit(const LimitState& state, const LimitInput& input,
                                const LimitOptions& options);

}  // namespace madori::control
