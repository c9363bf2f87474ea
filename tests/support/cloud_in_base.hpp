#pragma once

#include <cmath>

#include "core/lidar_model.hpp"
#include "core/point_cloud.hpp"
#include "localization/motion_model/odometry_track.hpp"

namespace madori::test {

/// A revolution in the Base frame of its last firing: each point is moved by what the wheels did since its
/// own. The result's stamp is the last firing's, its time offsets are zero. Where the track knows nothing,
/// the vehicle counts as standing.
inline PointCloud<Base> cloud_in_base(const PointCloud<Lidar>& cloud, const LidarModel& lidar,
                                      const localization::OdometryTrack& track) {
  constexpr float kOneFiringS = 4e-4F;  // points this near in time share a motion: 0.4 mm at 1 m/s
  const auto base_from_lidar = lidar.mounting.base_from_lidar();
  PointCloud<Base> result;
  const float last_s = cloud.points.empty() ? 0.0F : cloud.points.back().time_offset_s;
  result.stamp = cloud.stamp + duration_from_seconds(static_cast<double>(last_s));
  result.points.reserve(cloud.points.size());
  const auto end = track.at(result.stamp);
  float moment_s = std::nanf("");
  Transform2<Base, Lidar> moved = base_from_lidar;
  for (const CloudPoint& p : cloud.points) {
    if (end && !(std::abs(p.time_offset_s - moment_s) < kOneFiringS)) {
      moment_s = p.time_offset_s;
      const auto then = track.at(cloud.stamp + duration_from_seconds(static_cast<double>(moment_s)));
      moved = end->odom_from_base.inverse() * then.value_or(*end).odom_from_base * base_from_lidar;
    }
    const Point2<Base> at = moved * Point2<Lidar>{static_cast<double>(p.x_m), static_cast<double>(p.y_m)};
    CloudPoint q = p;
    q.x_m = static_cast<float>(at.x_m);
    q.y_m = static_cast<float>(at.y_m);
    q.z_m = p.z_m + static_cast<float>(lidar.mounting.z_m);
    q.time_offset_s = 0.0F;
    result.points.push_back(q);
  }
  return result;
}

}  // namespace madori::test
