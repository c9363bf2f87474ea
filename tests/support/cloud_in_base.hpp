#pragma once

#include "core/sweep_in_base.hpp"
#include "localization/motion_model/odometry_track.hpp"

namespace madori::test {

/// A whole sweep by what the wheels did since each of its points.
inline PointCloud<Base> cloud_in_base(const PointCloud<Lidar>& cloud, const LidarModel& lidar,
                                      const localization::OdometryTrack& track) {
  return sweep_in_base(
      cloud, lidar.mounting,
      [&](Stamp moment) -> std::optional<Transform2<Odom, Base>> {
        const auto reading = track.at(moment);
        return reading ? std::optional(reading->odom_from_base) : std::nullopt;
      },
      [](const Point2<Base>&, double) { return true; });
}

}  // namespace madori::test
