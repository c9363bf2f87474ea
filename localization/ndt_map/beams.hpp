#pragma once

#include <vector>

#include "core/frames.hpp"
#include "core/lidar_model.hpp"
#include "core/point2.hpp"
#include "core/point_cloud.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// The returns of one look with where they were seen from: Base frame, metres, heights above the floor. Beams
/// that did not return are no part of it: nothing at all looks like something dark or shiny.
struct Beams {
  struct End {
    float x_m = 0.0F, y_m = 0.0F, z_m = 0.0F;
  };
  Point2<Base> sensor;
  double sensor_z_m = 0.0;
  std::vector<End> ends;
};

/// Of a level lidar at that height. However low it is mounted, what it sees stands in the way: heights are
/// brought into those that count.
[[nodiscard]] Beams beams_of(const ScanPoints& points, const Point2<Base>& sensor, double sensor_z_m);
/// Of a sweep, one return a laser and half degree.
[[nodiscard]] Beams beams_of(const PointCloud<Base>& sweep, const LidarModel& lidar);

}  // namespace madori::localization
