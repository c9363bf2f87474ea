#include "localization/memory/surface_scan.hpp"

#include <algorithm>
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

/// Places in a scan, the point's own and its neighbours'.
using Neighbours = std::vector<std::size_t>;

/// How far the neighbours of a point are looked for that tell the direction of its surface: the noisier the
/// points, the more of them, and the further.
struct Reach {
  explicit Reach(double noise_m) {
    const double times = std::max(1.0, noise_m / kUsualNoiseM);
    gap_m *= times, reach_m *= times;
    to_each_side = static_cast<std::size_t>(static_cast<double>(to_each_side) * times * times);
    across_m2 = 1.5 * std::max(0.0, noise_m * noise_m - kUsualNoiseM * kUsualNoiseM);
  }
  double gap_m = 0.15, reach_m = 0.25;
  std::size_t to_each_side = 4;
  double across_m2 = 0.0;  ///< what the noise alone makes a line thick by
};

/// Total least squares line through the points; false where they are no line.
bool fit_normal(const std::vector<Polar>& scan, const Neighbours& of, double across_m2, SurfacePoint& out) {
  const auto n = static_cast<double>(of.size());
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
  if (mean + spread <= 0.0 || (mean - spread) - n * across_m2 > kFlat * (mean + spread)) {
    return false;
  }
  const double direction = 0.5 * std::atan2(2.0 * xy, xx - yy);
  out.normal_x = -std::sin(direction);
  out.normal_y = std::cos(direction);
  return true;
}

/// The points around i that lie on the same surface. A lidar that looks over things sees several surfaces in
/// one direction: those of the others are passed over.
void find_neighbours(const std::vector<Polar>& scan, std::size_t i, const Reach& reach, Neighbours& found) {
  const std::size_t look = 4 * reach.to_each_side;
  const double gap_m = std::max(reach.gap_m, 0.06 * scan[i].range_m);
  const double reach_m = std::max(reach.reach_m, 0.1 * scan[i].range_m);
  found.assign(1, i);
  for (const bool up : {false, true}) {
    std::size_t last = i;
    std::size_t taken = 0;
    for (std::size_t step = 1; step <= look && taken < reach.to_each_side; ++step) {
      if (up ? i + step >= scan.size() : step > i) break;
      const std::size_t k = up ? i + step : i - step;
      if (distance_m(scan[last].point, scan[k].point) >= gap_m ||
          distance_m(scan[i].point, scan[k].point) >= reach_m)
        continue;
      found.push_back(last = k);
      ++taken;
    }
  }
}

SurfacePoint surface_point(const std::vector<Polar>& scan, std::size_t i, const Point2<Base>& sensor,
                           const Reach& reach, Neighbours& of) {
  SurfacePoint p{scan[i].point.x_m, scan[i].point.y_m};
  find_neighbours(scan, i, reach, of);
  if (of.size() >= 3 && fit_normal(scan, of, reach.across_m2, p)) {
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
  const Reach reach(options.noise_m);
  const Point2<Base>* kept = nullptr;
  for (std::size_t i = 0; i < polar_.size(); ++i) {
    if (kept != nullptr && distance_m(*kept, polar_[i].point) < options.spacing_m) {
      continue;
    }
    kept = &polar_[i].point;
    scan_.points.push_back(surface_point(polar_, i, sensor, reach, neighbours_));
  }
  return scan_;
}

SurfaceScan make_surface_scan(Stamp stamp, const Point2<Base>& sensor,
                              const std::vector<Point2<Base>>& points, const SurfaceScanOptions& options) {
  return SurfaceScanner().make(stamp, sensor, points, options);
}

}  // namespace madori::localization
