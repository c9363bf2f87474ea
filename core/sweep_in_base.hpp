#pragma once

#include <cmath>
#include <optional>

#include "core/lidar_model.hpp"
#include "core/point_cloud.hpp"

namespace madori {

/// A sweep in the Base frame of its last firing: each point is moved by what the vehicle did since its own.
/// `odom_from_base_at(Stamp)` gives the wheels' pose, or nothing: then the vehicle counts as standing.
/// Points that `keep(Point2<Base>, height_m)` refuses are left out. The result's stamp is the last firing's,
/// its time offsets are zero, heights are above the floor. It takes the place of what `result` holds.
template <class PoseAt, class Keep>
void sweep_in_base(const PointCloud<Lidar>& cloud, const LidarMounting& mounting, PoseAt&& odom_from_base_at,
                   Keep&& keep, PointCloud<Base>& result) {
  constexpr float kOneFiringS = 5e-4F;  // points this near in time share a motion: 0.5 mm at 1 m/s
  result.lidar = cloud.lidar;
  const float last_s = cloud.points.empty() ? 0.0F : cloud.points.back().time_offset_s;
  result.stamp = cloud.stamp + duration_from_seconds(static_cast<double>(last_s));
  result.points.clear();
  result.points.reserve(cloud.points.size());
  const Transform2<Base, Lidar> base_from_lidar = mounting.base_from_lidar();
  const std::optional<Transform2<Odom, Base>> end = odom_from_base_at(result.stamp);
  const Transform2<Base, Odom> end_from_odom = end ? end->inverse() : Transform2<Base, Odom>();
  float moment_s = std::nanf("");
  Transform2<Base, Lidar> moved = base_from_lidar;
  for (const CloudPoint& p : cloud.points) {
    if (end && !(std::abs(p.time_offset_s - moment_s) < kOneFiringS)) {
      moment_s = p.time_offset_s;
      const Stamp moment = cloud.stamp + duration_from_seconds(static_cast<double>(moment_s));
      moved = end_from_odom * odom_from_base_at(moment).value_or(*end) * base_from_lidar;
    }
    const Point2<Base> at = moved * Point2<Lidar>{static_cast<double>(p.x_m), static_cast<double>(p.y_m)};
    const float height_m = p.z_m + static_cast<float>(mounting.z_m);
    if (!keep(at, static_cast<double>(height_m))) continue;
    CloudPoint q = p;
    q.x_m = static_cast<float>(at.x_m);
    q.y_m = static_cast<float>(at.y_m);
    q.z_m = height_m;
    q.time_offset_s = 0.0F;
    result.points.push_back(q);
  }
}

template <class PoseAt, class Keep>
[[nodiscard]] PointCloud<Base> sweep_in_base(const PointCloud<Lidar>& cloud, const LidarMounting& mounting,
                                             PoseAt&& odom_from_base_at, Keep&& keep) {
  PointCloud<Base> result;
  sweep_in_base(cloud, mounting, odom_from_base_at, keep, result);
  return result;
}

}  // namespace madori
