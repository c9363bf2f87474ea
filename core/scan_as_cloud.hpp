#pragma once

#include <cmath>

#include "core/laser_scan.hpp"
#include "core/point_cloud.hpp"

namespace madori {

/// A planar scan as points of its own plane, in place of what `cloud` holds; beams without a return are left
/// out.
inline void scan_as_cloud(const LaserScan& scan, PointCloud<Lidar>& cloud) {
  cloud.stamp = scan.stamp;
  cloud.lidar = scan.lidar;
  cloud.points.clear();
  cloud.points.reserve(scan.ranges_m.size());
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const float range_m = scan.ranges_m[i];
    if (!(range_m > 0.0F && static_cast<double>(range_m) < scan.range_max_m)) continue;
    const double angle = scan.angle_rad(i);
    const double after_s = to_seconds(scan.beam_period) * static_cast<double>(i);
    cloud.points.push_back({range_m * static_cast<float>(std::cos(angle)),
                            range_m * static_cast<float>(std::sin(angle)), 0.0F, static_cast<float>(after_s),
                            0, 0});
  }
}

}  // namespace madori
