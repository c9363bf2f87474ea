#pragma once

#include <cstddef>
#include <vector>

#include "core/frames.hpp"
#include "core/laser_scan.hpp"
#include "core/point2.hpp"
#include "core/transform2.hpp"

namespace madori::localization {

/// End points of one scan in the Base frame, metres, as structure of arrays. Near the sensor a float is exact
/// to micrometres. `weight` is empty (all one) or one a point, 0 = ignore, 1 = surely a wall. The normals are
/// empty or one unit vector a point (towards the sensor); (0, 0) where the surface's direction is not known.
struct ScanPoints {
  std::vector<float> x_m;
  std::vector<float> y_m;
  std::vector<float> weight;
  std::vector<float> normal_x;
  std::vector<float> normal_y;

  [[nodiscard]] std::size_t size() const { return x_m.size(); }
  [[nodiscard]] bool empty() const { return x_m.empty(); }
  void clear() {
    for (auto* part : {&x_m, &y_m, &weight, &normal_x, &normal_y}) part->clear();
  }
  void add(double x, double y) {
    x_m.push_back(static_cast<float>(x));
    y_m.push_back(static_cast<float>(y));
  }
  [[nodiscard]] Point2<Base> point(std::size_t i) const { return {x_m[i], y_m[i]}; }
  [[nodiscard]] double weight_of(std::size_t i) const { return weight.empty() ? 1.0 : weight[i]; }
};

/// Those that count, a weight above 0, in place of what `out` holds.
inline void weighty_points(const ScanPoints& points, std::vector<Point2<Base>>& out) {
  out.clear();
  out.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points.weight_of(i) > 0.0) out.push_back(points.point(i));
}
[[nodiscard]] inline std::vector<Point2<Base>> weighty_points(const ScanPoints& points) {
  std::vector<Point2<Base>> out;
  weighty_points(points, out);
  return out;
}

/// The returns of `scan` as points; no returns, non-finite ranges and such below `range_min_m` are left out.
[[nodiscard]] inline ScanPoints scan_points(const LaserScan& scan,
                                            const Transform2<Base, Lidar>& base_from_lidar,
                                            double range_min_m = 0.05) {
  ScanPoints points;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range = scan.ranges_m[i];
    if (!(range >= range_min_m) || !(range < scan.range_max_m)) continue;
    const double angle = scan.angle_rad(i);
    const Point2<Base> p = base_from_lidar * Point2<Lidar>{range * std::cos(angle), range * std::sin(angle)};
    points.add(p.x_m, p.y_m);
  }
  return points;
}

}  // namespace madori::localization
