#pragma once

namespace madori {

/// What the vehicle shall do now, Base frame.
struct VelocityCommand {
  double linear_mps = 0.0;     ///< positive forward
  double angular_radps = 0.0;  ///< positive turns left

  friend bool operator==(const VelocityCommand&, const VelocityCommand&) = default;
};

}  // namespace madori
