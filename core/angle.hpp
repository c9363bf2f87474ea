#pragma once

#include <cmath>
#include <numbers>

namespace madori {

inline constexpr double kPi = std::numbers::pi;

/// The same direction in [-pi, pi); NaN stays NaN.
[[nodiscard]] inline double wrap_angle(double angle_rad) {
  const double turns = std::floor((angle_rad + kPi) / (2.0 * kPi));
  const double wrapped = angle_rad - 2.0 * kPi * turns;
  return wrapped >= kPi ? -kPi : wrapped;
}

[[nodiscard]] constexpr double to_rad(double degrees) {
  return degrees * (kPi / 180.0);
}
[[nodiscard]] constexpr double to_deg(double radians) {
  return radians * (180.0 / kPi);
}

}  // namespace madori
