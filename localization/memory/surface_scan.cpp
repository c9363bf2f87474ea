#include "localization/memory/surface_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace madori::localization {
namespace {

using Polar = SurfaceScanner::Polar;

void sort_by_bearing(const Point2<Base>& sensor, const std::vector<Point2<Base>>& points, double range_max_m,
                     std::vector<Polar>& polar) {
  polar.clear();
  polar.reserve(points.size());
  for (const Point2<Base>& p : points) {
    const double dx = p.x_m - sensor.x_m;
    const double dy = p.y_m - sensor.y_m;
    const double range = std::hypot(dx, dy);
    if (std::isfinite(range) && range > 0.05 && range < range_max_m) {
      polar.push_back({std::atan2(dy, dx), range, p});
    }
  }
  std::sort(polar.begin(), polar.end(), [](const Polar& a, const Polar& b) {
    return std::pair(a.bearing_rad, a.range_m) < std::pair(b.bearing_rad, b.range_m);
  });
}

constexpr std::size_t kReach = 4;  ///< neighbours to each side

/// Places in a scan, the point's own and its neighbours'.
struct Neighbours {
  std::array<std::size_t, 2 * kReach + 1> places;
  std::size_t count = 0;

  void add(std::size_t place) { places[count++] = place; }
  [[nodiscard]] auto begin() const { return places.begin(); }
  [[nodiscard]] auto end() const { return places.begin() + count; }
};

/// Total least squares line through the points; false where they are no line.
bool fit_normal(const std::vector<Polar>& scan, const Neighbours& of, SurfacePoint& out) {
  const double n = static_cast<double>(of.count);
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (const std::size_t i : of) {
    mean_x += scan[i].point.x_m / n;
    mean_y += scan[i].point.y_m / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const std::size_t i : of) {
    const double dx = scan[i].point.x_m - mean_x;
    const double dy = scan[i].point.y_m - mean_y;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  const double mean = 0.5 * (xx + yy);
  const double spread = std::hypot(0.5 * (xx - yy), xy);
  constexpr double kFlat = 0.04;  // ratio of the principal variances: a fifth in length
  if (mean + spread <= 0.0 || (mean - spread) > kFlat * (mean + spread)) {
    return false;
  }
  const double direction = 0.5 * std::atan2(2.0 * xy, xx - yy);
  out.normal_x = -std::sin(direction);
  out.normal_y = std::cos(direction);
  return true;
}

/// The points around i that lie on the same surface, at most kReach to each side. A lidar that looks over
/// things sees several surfaces in one direction: those of the others are passed over.
Neighbours neighbourhood(const std::vector<Polar>& scan, std::size_t i) {
  constexpr std::size_t kLook = 16;
  const double gap_m = std::max(0.15, 0.06 * scan[i].range_m);
  const double reach_m = std::max(0.25, 0.1 * scan[i].range_m);
  Neighbours found;
  found.add(i);
  for (const bool up : {false, true}) {
    std::size_t last = i;
    std::size_t taken = 0;
    for (std::size_t step = 1; step <= kLook && taken < kReach; ++step) {
      if (up ? i + step >= scan.size() : step > i) break;
      const std::size_t k = up ? i + step : i - step;
      if (distance_m(scan[last].point, scan[k].point) >= gap_m ||
          distance_m(scan[i].point, scan[k].point) >= reach_m)
        continue;
      found.add(last = k);
      ++taken;
    }
  }
  return found;
}

SurfacePoint surface_point(const std::vector<Polar>& scan, std::size_t i, const Point2<Base>& sensor) {
  SurfacePoint p{scan[i].point.x_m, scan[i].point.y_m};
  const Neighbours of = neighbourhood(scan, i);
  if (of.count >= 3 && fit_normal(scan, of, p)) {
    const double towards = (sensor.x_m - p.x_m) * p.normal_x + (sensor.y_m - p.y_m) * p.normal_y;
    if (towards < 0.0) {
      p.normal_x = -p.normal_x;
      p.normal_y = -p.normal_y;
    }
  }
  return p;
}

}  // namespace

const SurfaceScan& SurfaceScanner::make(Stamp stamp, const Point2<Base>& sensor,
                                        const std::vector<Point2<Base>>& points,
                                        const SurfaceScanOptions& options) {
  sort_by_bearing(sensor, points, options.range_max_m, polar_);
  scan_.stamp = stamp;
  scan_.sensor = sensor;
  scan_.points.clear();
  scan_.points.reserve(polar_.size());
  const Point2<Base>* kept = nullptr;
  for (std::size_t i = 0; i < polar_.size(); ++i) {
    if (kept != nullptr && distance_m(*kept, polar_[i].point) < options.spacing_m) {
      continue;
    }
    kept = &polar_[i].point;
    scan_.points.push_back(surface_point(polar_, i, sensor));
  }
  return scan_;
}

SurfaceScan make_surface_scan(Stamp stamp, const Point2<Base>& sensor,
                              const std::vector<Point2<Base>>& points, const SurfaceScanOptions& options) {
  return SurfaceScanner().make(stamp, sensor, points, options);
}

}  // namespace madori::localization
