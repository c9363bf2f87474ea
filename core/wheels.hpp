#pragma once

#include <cmath>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori {

/// Two driven wheels on one axle through the Base origin.
struct WheelGeometry {
  double left_radius_m = 0.1;
  double right_radius_m = 0.1;
  double half_separation_m =
      0.25;  ///< `d` of the layout-map paper's Eq. (3), which is half the wheel separation
};

/// The motion of Base while both wheels turn evenly by these angles: Eq. (1)-(4) of the layout-map paper
/// times the time step, integrated exactly along the arc. The result is base_before_from_base_after.
[[nodiscard]] inline Transform2<Base, Base> arc_step(const WheelGeometry& wheels, double left_rad,
                                                     double right_rad) {
  const double left_m = wheels.left_radius_m * left_rad;
  const double right_m = wheels.right_radius_m * right_rad;
  const double length_m = (right_m + left_m) / 2.0;
  const double turn_rad = (right_m - left_m) / (2.0 * wheels.half_separation_m);
  const double half = turn_rad / 2.0;
  const double chord_m = length_m * (std::abs(half) < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half);
  return {chord_m * std::cos(half), chord_m * std::sin(half), turn_rad};
}

/// The angles by which the wheels turned in such a step: the inverse of arc_step().
struct WheelTurns {
  double left_rad = 0.0;
  double right_rad = 0.0;
};
[[nodiscard]] inline WheelTurns wheel_turns(const WheelGeometry& wheels, const Transform2<Base, Base>& step) {
  const double half = step.yaw_rad() / 2.0;
  const double chord_m = step.x_m() * std::cos(half) + step.y_m() * std::sin(half);
  const double length_m = chord_m * (std::abs(half) < 1e-4 ? 1.0 + half * half / 6.0 : half / std::sin(half));
  const double apart_m = step.yaw_rad() * wheels.half_separation_m;
  return {(length_m - apart_m) / wheels.left_radius_m, (length_m + apart_m) / wheels.right_radius_m};
}

}  // namespace madori
