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

/// What of a wall the returns before it in its sector leave in sight: rises per metre from the lidar. What
/// stands before it hides it from below, a ceiling, a beam or a lamp from above.
struct Sight {
  double from = -INFINITY;
  double to = INFINITY;
};

/// What the judgement of a wall rests on.
struct Judge {
  const LidarModel& lidar;
  const CloudWallOptions& options;
};

double rise_of(const Return& r, const LidarModel& lidar) {
  return (static_cast<double>(r.z_m) - lidar.mounting.z_m) / static_cast<double>(r.range_m);
}

/// Of a surface between two rises, past the returns begin..end of its sector.
Sight sight_past(const std::vector<Return>& returns, std::size_t begin, std::size_t end, double low_rise,
                 double high_rise, const LidarModel& lidar) {
  Sight sight;
  for (std::size_t i = begin; i < end; ++i) {
    const double rise = rise_of(returns[i], lidar);
    if (rise <= low_rise)
      sight.from = std::max(sight.from, rise);
    else if (rise >= high_rise)
      sight.to = std::min(sight.to, rise);
  }
  return sight;
}

/// Height of the part of a wall at `range_m` that the lasers cover within the region of interest and in
/// sight.
double coverable_m(double range_m, const Sight& sight, const Judge& judge) {
  const auto& [lidar, o] = judge;
  const double rise = std::tan(lidar.max_elevation_rad);
  const double fall = std::tan(lidar.min_elevation_rad);
  const double z_m = lidar.mounting.z_m;
  const double top = std::min(o.max_height_m, z_m + range_m * std::min(rise, sight.to));
  const double bottom = std::max(o.min_height_m, z_m + range_m * std::max(fall, sight.from));
  return std::max(top - bottom, 0.0);
}

/// How surely returns first..last of the sector that begins at `begin`, all about as far away, are of a wall:
/// 0 = not.
double wall_weight(const std::vector<Return>& returns, std::size_t begin, std::size_t first, std::size_t last,
                   const Judge& judge) {
  const auto& [lidar, options] = judge;
  float low = returns[first].z_m;
  float high = low;
  for (std::size_t i = first; i <= last; ++i) {
    low = std::min(low, returns[i].z_m);
    high = std::max(high, returns[i].z_m);
  }
  const double range = returns[first].range_m;
  const double ring_m = range * lidar.ring_step_rad;
  const Sight sight = sight_past(returns, begin, first, (low - lidar.mounting.z_m) / range,
                                 (high - lidar.mounting.z_m) / range, lidar);
  const double possible =
      coverable_m(range, sight, judge) - ring_m;  // the outer lasers miss up to a step in all
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

ScanPoints all_returns(const PointCloud<Base>& cloud, const LidarModel& lidar,
                       const CloudWallOptions& options) {
  ScanPoints points;
  for (const CloudPoint& p : cloud.points) {
    const double x = p.x_m, y = p.y_m;
    if (std::hypot(x - lidar.mounting.x_m, y - lidar.mounting.y_m) <= options.max_range_m) points.add(x, y);
  }
  return points;
}

}  // namespace

ScanPoints extract_walls(const PointCloud<Base>& cloud, const LidarModel& lidar,
                         const CloudWallOptions& options) {
  if (lidar.kind == LidarKind::Planar) return all_returns(cloud, lidar, options);
  const std::vector<Return> returns = region_of_interest(cloud, options);
  ScanPoints points;
  std::size_t begin = 0;  // of the sector
  for (std::size_t first = 0; first < returns.size();) {
    std::size_t last = first;
    while (last + 1 < returns.size() && returns[last + 1].sector == returns[first].sector &&
           returns[last + 1].range_m - returns[last].range_m <= options.surface_gap_m)
      ++last;
    if (returns[first].sector != returns[begin].sector) begin = first;
    const double weight = wall_weight(returns, begin, first, last, {lidar, options});
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
