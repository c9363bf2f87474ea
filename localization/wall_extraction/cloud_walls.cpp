#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "localization/wall_extraction/wall_extraction.hpp"

namespace madori::localization {
namespace {

/// A return inside the region of interest.
struct Return {
  std::uint32_t sector;
  float range_m;
  float z_m;
  std::uint32_t index;
};

/// By sector, then by range: counted into the sectors, each sorted by itself.
std::vector<Return> sorted(const std::vector<Return>& returns, int sectors) {
  std::vector<std::size_t> begin(static_cast<std::size_t>(sectors) + 1, 0);
  for (const Return& r : returns) ++begin[r.sector + 1];
  for (std::size_t s = 1; s < begin.size(); ++s) begin[s] += begin[s - 1];
  std::vector<std::size_t> next = begin;
  std::vector<Return> result(returns.size());
  for (const Return& r : returns) result[next[r.sector]++] = r;
  for (std::size_t s = 0; s + 1 < begin.size(); ++s)
    std::sort(result.begin() + static_cast<std::ptrdiff_t>(begin[s]),
              result.begin() + static_cast<std::ptrdiff_t>(begin[s + 1]),
              [](const Return& a, const Return& b) { return a.range_m < b.range_m; });
  return result;
}

std::vector<Return> region_of_interest(const PointCloud<Base>& cloud, const CloudWallOptions& options) {
  std::vector<Return> inside;
  inside.reserve(cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const CloudPoint& p = cloud.points[i];
    const double range = std::hypot(p.x_m, p.y_m);
    if (!(p.z_m >= options.min_height_m && p.z_m <= options.max_height_m)) continue;
    if (!(range >= options.min_range_m && range <= options.max_range_m)) continue;
    const double turn = (std::atan2(p.y_m, p.x_m) + kPi) / (2.0 * kPi);
    const auto sector = static_cast<std::uint32_t>(std::min(turn, 0.999999) * options.sectors);
    inside.push_back({sector, static_cast<float>(range), p.z_m, static_cast<std::uint32_t>(i)});
  }
  return sorted(inside, options.sectors);
}

/// Height of the part of a wall at `range_m` that the lasers cover within the region of interest, above the
/// line of sight over what stands before it (its rise per metre).
double coverable_m(double range_m, double sight_rise, const CloudWallOptions& o) {
  const double rise = std::tan(o.max_elevation_rad);
  const double top = std::min(o.max_height_m, o.sensor_height_m + range_m * rise);
  const double bottom = std::max(o.min_height_m, o.sensor_height_m + range_m * std::max(-rise, sight_rise));
  return std::max(top - bottom, 0.0);
}

/// How surely returns first..last of one sector, all about as far away, are of a wall: 0 = not.
double wall_weight(const std::vector<Return>& returns, std::size_t first, std::size_t last, double sight_rise,
                   const CloudWallOptions& options) {
  float low = returns[first].z_m;
  float high = low;
  for (std::size_t i = first; i <= last; ++i) {
    low = std::min(low, returns[i].z_m);
    high = std::max(high, returns[i].z_m);
  }
  const double range = returns[first].range_m;
  const double ring_m = range * options.ring_step_rad;
  const double possible =
      coverable_m(range, sight_rise, options) - ring_m;  // the outer lasers miss up to a step in all
  const double extent = high - low;
  if (possible <= ring_m) return last > first ? 0.5 : 0.25;  // no more than two lasers could have met it
  if (last == first) return 0.0;
  const double share = extent / possible;
  return share >= options.least_extent ? std::min(share, 1.0) : 0.0;
}

/// Keeps one point a voxel: the mean of those that fell into it, by weight.
ScanPoints thinned(const ScanPoints& points, double voxel_m) {
  struct Sum {
    double x = 0.0, y = 0.0, w = 0.0, most = 0.0;
  };
  std::unordered_map<std::uint64_t, std::size_t> slot;
  std::vector<Sum> sums;  // in the order of the sectors, so that neighbours stay neighbours
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto u = static_cast<std::int32_t>(std::floor(points.x_m[i] / voxel_m));
    const auto v = static_cast<std::int32_t>(std::floor(points.y_m[i] / voxel_m));
    const std::uint64_t key =
        (std::uint64_t{static_cast<std::uint32_t>(u)} << 32) | static_cast<std::uint32_t>(v);
    const auto [at, fresh] = slot.try_emplace(key, sums.size());
    if (fresh) sums.emplace_back();
    Sum& sum = sums[at->second];
    const double w = points.weight[i];
    sum.x += w * points.x_m[i];
    sum.y += w * points.y_m[i];
    sum.w += w;
    sum.most = std::max(sum.most, w);
  }
  ScanPoints kept;
  for (const Sum& sum : sums) {
    kept.add(sum.x / sum.w, sum.y / sum.w);
    kept.weight.push_back(static_cast<float>(sum.most));
  }
  return kept;
}

/// Normals from the neighbours on both sides; none where these do not lie in a line.
void add_normals(ScanPoints& points) {
  constexpr double kNear = 1.0;
  constexpr double kBend = 0.2;
  points.normal_x.assign(points.size(), 0.0F);
  points.normal_y.assign(points.size(), 0.0F);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Point2<Base> a = points.point(i - 1);
    const Point2<Base> p = points.point(i);
    const Point2<Base> b = points.point(i + 1);
    const double chord = distance_m(a, b);
    if (distance_m(a, p) > kNear || distance_m(p, b) > kNear || chord < 1e-3) continue;
    double nx = -(b.y_m - a.y_m) / chord;
    double ny = (b.x_m - a.x_m) / chord;
    if (std::abs(nx * (p.x_m - a.x_m) + ny * (p.y_m - a.y_m)) > kBend * chord) continue;
    if (nx * p.x_m + ny * p.y_m > 0.0) nx = -nx, ny = -ny;  // towards the sensor
    points.normal_x[i] = static_cast<float>(nx);
    points.normal_y[i] = static_cast<float>(ny);
  }
}

}  // namespace

ScanPoints extract_walls(const PointCloud<Base>& cloud, const CloudWallOptions& options) {
  const std::vector<Return> returns = region_of_interest(cloud, options);
  ScanPoints points;
  double sight_rise = -INFINITY;  // over the surfaces of the sector so far
  for (std::size_t first = 0; first < returns.size();) {
    std::size_t last = first;
    while (last + 1 < returns.size() && returns[last + 1].sector == returns[first].sector &&
           returns[last + 1].range_m - returns[last].range_m <= options.surface_gap_m)
      ++last;
    if (first == 0 || returns[first].sector != returns[first - 1].sector) sight_rise = -INFINITY;
    const double weight = wall_weight(returns, first, last, sight_rise, options);
    for (std::size_t i = first; i <= last; ++i)
      sight_rise = std::max(sight_rise, (returns[i].z_m - options.sensor_height_m) / returns[i].range_m);
    if (weight > 0.0) {
      double x = 0.0, y = 0.0;
      for (std::size_t i = first; i <= last; ++i) {
        x += cloud.points[returns[i].index].x_m;
        y += cloud.points[returns[i].index].y_m;
      }
      const auto n = static_cast<double>(last - first + 1);
      points.add(x / n, y / n);
      points.weight.push_back(static_cast<float>(weight));
    }
    first = last + 1;
  }
  ScanPoints kept = thinned(points, options.voxel_m);
  add_normals(kept);
  return kept;
}

}  // namespace madori::localization
