#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "localization/wall_extraction/wall_extractor.hpp"

namespace madori::localization {
namespace {

using Return = WallExtractor::Return;

constexpr double kMinHeightM = 1.6;  ///< of the region of interest, Base: above equipment, heads, loads
constexpr double kMaxHeightM = 6.0;
constexpr double kMinRangeM = 0.6;  ///< of the lidar
constexpr double kMaxRangeM = 80.0;
constexpr int kSectors = 720;         ///< the fans, by azimuth about the lidar
constexpr double kSurfaceGapM = 0.2;  ///< returns of a sector farther apart than this are of two surfaces
constexpr double kLeastExtent = 0.5;  ///< of the height that the lasers could have covered at that distance
constexpr double kVoxelM = 0.1;

/// What of a wall the returns before it in its sector leave in sight: rises per metre from the lidar. What
/// stands before it hides it from below, a ceiling, a beam or a lamp from above.
struct Sight {
  double from = -INFINITY;
  double to = INFINITY;
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
double coverable_m(double range_m, const Sight& sight, const LidarModel& lidar) {
  const double rise = std::tan(lidar.max_elevation_rad);
  const double fall = std::tan(lidar.min_elevation_rad);
  const double z_m = lidar.mounting.z_m;
  const double top = std::min(kMaxHeightM, z_m + range_m * std::min(rise, sight.to));
  const double bottom = std::max(kMinHeightM, z_m + range_m * std::max(fall, sight.from));
  return std::max(top - bottom, 0.0);
}

/// How surely returns first..last of the sector that begins at `begin`, all about as far away, are of a wall:
/// 0 = not.
double wall_weight(const std::vector<Return>& returns, std::size_t begin, std::size_t first, std::size_t last,
                   const LidarModel& lidar) {
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
      coverable_m(range, sight, lidar) - ring_m;  // the outer lasers miss up to a step in all
  const double extent = high - low;
  if (possible <= ring_m) return last > first ? 0.5 : 0.25;  // no more than two lasers could have met it
  if (last == first) return 0.0;
  const double share = extent / possible;
  return share >= kLeastExtent ? std::min(share, 1.0) : 0.0;
}

/// Normals from the neighbours on both sides; none where these do not lie in a line.
void add_normals(const LidarMounting& lidar, ScanPoints& points) {
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
    if (nx * (p.x_m - lidar.x_m) + ny * (p.y_m - lidar.y_m) > 0.0) nx = -nx, ny = -ny;  // towards the sensor
    points.normal_x[i] = static_cast<float>(nx);
    points.normal_y[i] = static_cast<float>(ny);
  }
}

void take_all_returns(const PointCloud<Base>& cloud, const LidarModel& lidar, ScanPoints& points) {
  for (const CloudPoint& p : cloud.points) {
    const double x = p.x_m, y = p.y_m;
    if (std::hypot(x - lidar.mounting.x_m, y - lidar.mounting.y_m) <= kMaxRangeM) points.add(x, y);
  }
}

}  // namespace

/// By sector, then by range: counted into the sectors, each sorted by itself.
void WallExtractor::sort_returns() {
  begin_.assign(kSectors + 1, 0);
  for (const Return& r : inside_) ++begin_[r.sector + 1];
  for (std::size_t s = 1; s < begin_.size(); ++s) begin_[s] += begin_[s - 1];
  next_ = begin_;
  returns_.resize(inside_.size());
  for (const Return& r : inside_) returns_[next_[r.sector]++] = r;
  for (std::size_t s = 0; s + 1 < begin_.size(); ++s)
    std::sort(returns_.begin() + static_cast<std::ptrdiff_t>(begin_[s]),
              returns_.begin() + static_cast<std::ptrdiff_t>(begin_[s + 1]),
              [](const Return& a, const Return& b) { return a.range_m < b.range_m; });
}

/// Sectors and ranges are the lidar's: only along its own rays does what stands before something hide it.
void WallExtractor::find_region_of_interest(const PointCloud<Base>& cloud, const LidarMounting& lidar) {
  inside_.clear();
  inside_.reserve(cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const CloudPoint& p = cloud.points[i];
    const double dx = p.x_m - lidar.x_m, dy = p.y_m - lidar.y_m;
    const double range = std::hypot(dx, dy);
    if (!(p.z_m >= kMinHeightM && p.z_m <= kMaxHeightM)) continue;
    if (!(range >= kMinRangeM && range <= kMaxRangeM)) continue;
    const double turn = (std::atan2(dy, dx) + kPi) / (2.0 * kPi);
    const auto sector = static_cast<std::uint32_t>(std::min(turn, 0.999999) * kSectors);
    inside_.push_back({sector, static_cast<float>(range), p.z_m, static_cast<std::uint32_t>(i)});
  }
  sort_returns();
}

void WallExtractor::find_surfaces(const PointCloud<Base>& cloud, const LidarModel& lidar) {
  surfaces_.clear();
  std::size_t begin = 0;  // of the sector
  for (std::size_t first = 0; first < returns_.size();) {
    std::size_t last = first;
    while (last + 1 < returns_.size() && returns_[last + 1].sector == returns_[first].sector &&
           returns_[last + 1].range_m - returns_[last].range_m <= kSurfaceGapM)
      ++last;
    if (returns_[first].sector != returns_[begin].sector) begin = first;
    const double weight = wall_weight(returns_, begin, first, last, lidar);
    if (weight > 0.0) {
      double x = 0.0, y = 0.0;
      for (std::size_t i = first; i <= last; ++i) {
        x += cloud.points[returns_[i].index].x_m;
        y += cloud.points[returns_[i].index].y_m;
      }
      const auto n = static_cast<double>(last - first + 1);
      surfaces_.add(x / n, y / n);
      surfaces_.weight.push_back(static_cast<float>(weight));
    }
    first = last + 1;
  }
}

WallExtractor::Sum& WallExtractor::sum_of(std::uint64_t voxel) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t at = (voxel * 0x9E3779B97F4A7C15ULL >> 32) & mask;
  while (slots_[at].sum >= 0 && slots_[at].voxel != voxel) at = (at + 1) & mask;
  if (slots_[at].sum < 0) {
    slots_[at] = {voxel, static_cast<std::int64_t>(sums_.size())};
    sums_.emplace_back();
  }
  return sums_[static_cast<std::size_t>(slots_[at].sum)];
}

/// Keeps one point a voxel: the mean of those that fell into it, by weight.
void WallExtractor::thin() {
  slots_.assign(std::bit_ceil(2 * surfaces_.size() + 2), {});
  sums_.clear();
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const auto u = static_cast<std::int32_t>(std::floor(surfaces_.x_m[i] / kVoxelM));
    const auto v = static_cast<std::int32_t>(std::floor(surfaces_.y_m[i] / kVoxelM));
    Sum& sum = sum_of((std::uint64_t{static_cast<std::uint32_t>(u)} << 32) | static_cast<std::uint32_t>(v));
    const double w = surfaces_.weight[i];
    sum.x += w * surfaces_.x_m[i];
    sum.y += w * surfaces_.y_m[i];
    sum.w += w;
    sum.most = std::max(sum.most, w);
  }
  for (const Sum& sum : sums_) {
    walls_.add(sum.x / sum.w, sum.y / sum.w);
    walls_.weight.push_back(static_cast<float>(sum.most));
  }
}

const ScanPoints& WallExtractor::extract(const PointCloud<Base>& cloud, const LidarModel& lidar) {
  walls_.clear();
  if (lidar.kind == LidarKind::Planar) {
    take_all_returns(cloud, lidar, walls_);
    return walls_;
  }
  find_region_of_interest(cloud, lidar.mounting);
  find_surfaces(cloud, lidar);
  thin();
  add_normals(lidar.mounting, walls_);
  return walls_;
}

ScanPoints extract_walls(const PointCloud<Base>& cloud, const LidarModel& lidar) {
  return WallExtractor().extract(cloud, lidar);
}

}  // namespace madori::localization
