#pragma once

#include <cmath>

#include "core/lidar_model.hpp"
#include "planning/obstacle_check/sight_history.hpp"

/// What a lidar surely sees ahead of the vehicle, by its data sheet and its mounting.
namespace madori::planning {

/// The narrowest standing body that must be seen: a leg (test body of IEC 61496-3).
inline constexpr double kLegM = 0.07;
/// Height and least width of a person who lies on the floor (test body of ISO 3691-4: 200 mm x 600 mm).
inline constexpr double kLyingM = 0.2;
/// As fast as a vehicle may drive that does not see who lies before it (ISO 3691-4).
inline constexpr double kUnseenPersonMps = 0.3;

/// How far before the vehicle's front this lidar is sure to see a leg straight ahead; 0 where it looks
/// elsewhere.
[[nodiscard]] inline double sure_ahead_m(const LidarModel& lidar, double front_m) {
  if (!SensorView::of(lidar).looks_at(0.0)) return 0.0;
  return std::fmax(0.0, lidar.mounting.x_m + lidar.sure_range_m(kLegM) - front_m);
}

/// How far before the vehicle's front this lidar is sure to have seen who lies on the floor straight ahead; 0
/// where it looks over him, or elsewhere. A level one sees him all the way. One whose lasers look down sees
/// him last where the lowest passes over him: that lies within `reach_m` of the Base origin, as far as what
/// was seen is remembered.
[[nodiscard]] inline double sure_low_m(const LidarModel& lidar, double front_m, double reach_m) {
  if (!SensorView::of(lidar).looks_at(0.0)) return 0.0;
  const double over_m = lidar.mounting.z_m - kLyingM;
  double range_m = lidar.sure_range_m(kLyingM);
  if (over_m > 0.0) {
    if (!(lidar.min_elevation_rad < 0.0)) return 0.0;
    const double last_m = over_m / std::tan(-lidar.min_elevation_rad);
    if (last_m > range_m || lidar.mounting.x_m + last_m > reach_m) return 0.0;
    range_m = last_m;
  }
  return std::fmax(0.0, lidar.mounting.x_m + range_m - front_m);
}

}  // namespace madori::planning
