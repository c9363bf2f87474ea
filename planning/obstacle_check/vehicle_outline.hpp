#pragma once

#include <cmath>

#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::planning {

/// The vehicle with its load seen from above, Base frame, and its height. Metres, all positive.
struct VehicleOutline {
  double front_m = 0.8;  ///< from the Base origin forward
  double rear_m = 0.2;   ///< ... and back
  double half_width_m = 0.3;
  double height_m = 0.8;

  /// The outline, wider on every side.
  [[nodiscard]] VehicleOutline grown(double ends_m, double sides_m) const {
    return grown(ends_m, ends_m, sides_m);
  }
  [[nodiscard]] VehicleOutline grown(double ahead_m, double behind_m, double sides_m) const {
    return {front_m + ahead_m, rear_m + behind_m, half_width_m + sides_m, height_m};
  }
  [[nodiscard]] bool contains(const Point2<Base>& p) const {
    return p.x_m >= -rear_m && p.x_m <= front_m && std::abs(p.y_m) <= half_width_m;
  }
  /// Furthest reach from the Base origin.
  [[nodiscard]] double reach_m() const { return std::hypot(std::fmax(front_m, rear_m), half_width_m); }
  [[nodiscard]] bool touches(const Segment2<Base>& s) const;
};

/// Whether any part of the segment lies within the outline (Liang-Barsky clipping).
inline bool VehicleOutline::touches(const Segment2<Base>& s) const {
  double enter = 0.0;
  double leave = 1.0;
  const auto clip = [&](double step, double room) {
    if (step == 0.0) return room >= 0.0;
    const double t = room / step;
    if (step < 0.0)
      enter = std::fmax(enter, t);
    else
      leave = std::fmin(leave, t);
    return enter <= leave;
  };
  const double dx = s.b.x_m - s.a.x_m;
  const double dy = s.b.y_m - s.a.y_m;
  return clip(-dx, s.a.x_m + rear_m) && clip(dx, front_m - s.a.x_m) && clip(-dy, s.a.y_m + half_width_m) &&
         clip(dy, half_width_m - s.a.y_m);
}

}  // namespace madori::planning
