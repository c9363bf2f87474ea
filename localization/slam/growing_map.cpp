#include "localization/slam/growing_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "localization/memory/surface_scan.hpp"
#include "localization/slam/range_ring.hpp"

namespace madori::localization {
namespace {

constexpr double kVoxelOfMapM = 0.05;   // at most one point a voxel
constexpr double kThroughSigmas = 3.0;  // a beam that ends so much farther has passed a point by,
constexpr double kLeastThroughM = 0.3;  // or so much at the least
constexpr double kLeastSurfaceM = 0.2;  // the points this near make the surface at one,
constexpr double kSurfaceSigmas = 2.0;  // or in so many sigmas
constexpr int kForgottenAfter = 2;      // beams that passed a point by, more than saw it

std::uint64_t key_of(const Point2<Map>& p) {
  constexpr std::int64_t kOffset = 1LL << 30;
  const auto ix =
      static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(p.x_m / kVoxelOfMapM)) + kOffset);
  const auto iy =
      static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(p.y_m / kVoxelOfMapM)) + kOffset);
  return (ix << 32U) | iy;
}

}  // namespace

void GrowingMap::look_through(const ScanPoints& scan, const Transform2<Map, Base>& map_from_base,
                              const Point2<Base>& sensor, double margin_m) {
  const RangeRing ring(scan, sensor);
  const Transform2<Base, Map> base_from_map = map_from_base.inverse();
  for (auto entry = voxels_.begin(); entry != voxels_.end();) {
    Voxel& voxel = entry->second;
    const Point2<Base> p = base_from_map * Point2<Map>{voxel.sum_x / voxel.seen, voxel.sum_y / voxel.seen};
    std::size_t direction = 0;
    if (ring.passes(p, margin_m, direction)) ++voxel.passed;
    entry = voxel.passed >= voxel.seen + kForgottenAfter ? voxels_.erase(entry) : std::next(entry);
  }
}

void GrowingMap::add(const ScanPoints& scan, const Transform2<Map, Base>& map_from_base,
                     const Point2<Base>& sensor, double noise_m) {
  look_through(scan, map_from_base, sensor, std::max(kLeastThroughM, kThroughSigmas * noise_m));
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Point2<Map> p = map_from_base * scan.point(i);
    Voxel& voxel = voxels_[key_of(p)];
    voxel.sum_x += p.x_m;
    voxel.sum_y += p.y_m;
    ++voxel.seen;
  }
  std::vector<std::pair<std::uint64_t, Voxel>> sorted(voxels_.begin(), voxels_.end());  // no hash's order
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  NoisyPoints cloud;
  for (const auto& [key, v] : sorted) {
    cloud.points.push_back({v.sum_x / v.seen, v.sum_y / v.seen});
    cloud.weights.push_back(v.seen);
  }
  noise_m_ += (noise_m - noise_m_) / static_cast<double>(++scans_);
  cloud.noise_m = std::max(kLeastNoiseM, noise_m_);
  points_ = PointMap(std::move(cloud), std::max(kLeastSurfaceM, kSurfaceSigmas * noise_m_));
}

}  // namespace madori::localization
