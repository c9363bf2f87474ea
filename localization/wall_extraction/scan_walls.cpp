#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/wall_extraction/wall_extraction.hpp"

namespace madori::localization {
namespace {

constexpr double kGapM = 0.3;        ///< neighbours farther apart (plus 5 % of the range) are of two surfaces
constexpr double kStraightM = 0.04;  ///< a surface bends where it leaves the chord by more (+ 0.5 % of range)
constexpr double kSureLengthM = 0.8;  ///< a straight stretch this long is surely a wall, shorter ones less
constexpr double kLeastWeight = 0.1;  ///< of a return without any line

double range_of(const ScanPoints& p, std::size_t i) {
  return std::hypot(p.x_m[i], p.y_m[i]);
}

/// Of the points first..last the one farthest from their chord, and how far.
std::pair<std::size_t, double> farthest(const ScanPoints& p, std::size_t first, std::size_t last) {
  const double dx = p.x_m[last] - p.x_m[first];
  const double dy = p.y_m[last] - p.y_m[first];
  const double length = std::max(std::hypot(dx, dy), 1e-9);
  std::pair<std::size_t, double> most{first, 0.0};
  for (std::size_t i = first + 1; i < last; ++i) {
    const double d = std::abs(dx * (p.y_m[i] - p.y_m[first]) - dy * (p.x_m[i] - p.x_m[first])) / length;
    if (d > most.second) most = {i, d};
  }
  return most;
}

/// Normal and weight of a straight stretch: total least squares through its points.
void mark_line(ScanPoints& p, std::size_t first, std::size_t last) {
  const auto n = static_cast<double>(last - first + 1);
  if (n < 3.0) return;
  double mx = 0.0, my = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = first; i <= last; ++i) mx += p.x_m[i] / n, my += p.y_m[i] / n;
  for (std::size_t i = first; i <= last; ++i) {
    const double dx = p.x_m[i] - mx;
    const double dy = p.y_m[i] - my;
    xx += dx * dx, xy += dx * dy, yy += dy * dy;
  }
  const double along = 0.5 * std::atan2(2.0 * xy, xx - yy);
  double nx = -std::sin(along);
  double ny = std::cos(along);
  if (nx * mx + ny * my > 0.0) nx = -nx, ny = -ny;  // towards the sensor
  const double length = std::hypot(p.x_m[last] - p.x_m[first], p.y_m[last] - p.y_m[first]);
  const double weight = std::clamp(length / kSureLengthM, kLeastWeight, 1.0);
  for (std::size_t i = first; i <= last; ++i) {
    p.normal_x[i] = static_cast<float>(nx);
    p.normal_y[i] = static_cast<float>(ny);
    p.weight[i] = static_cast<float>(weight);
  }
}

void split(ScanPoints& p, std::size_t first, std::size_t last) {
  if (last < first + 2) return;
  const auto [at, distance] = farthest(p, first, last);
  if (distance > kStraightM + 0.005 * range_of(p, at)) {
    split(p, first, at);
    split(p, at, last);
  } else {
    mark_line(p, first, last);
  }
}

}  // namespace

ScanPoints extract_walls(const LaserScan& scan, const Transform2<Base, Lidar>& base_from_lidar) {
  return extract_walls(scan_points(scan, base_from_lidar, kWallNearestM));
}

ScanPoints extract_walls(ScanPoints points) {
  points.weight.assign(points.size(), static_cast<float>(kLeastWeight));
  points.normal_x.assign(points.size(), 0.0F);
  points.normal_y.assign(points.size(), 0.0F);
  std::size_t first = 0;
  for (std::size_t i = 1; i <= points.size(); ++i) {
    const bool broken = i == points.size() || distance_m(points.point(i - 1), points.point(i)) >
                                                  kGapM + 0.05 * range_of(points, i - 1);
    if (!broken) continue;
    split(points, first, i - 1);
    first = i;
  }
  return points;
}

}  // namespace madori::localization
