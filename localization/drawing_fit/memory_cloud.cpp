#include "localization/drawing_fit/memory_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "localization/drawing_fit/wall_index.hpp"

namespace madori::localization {
namespace {

/// Directed normals tell the two faces of a thin wall apart.
constexpr int kFacings = 8;

int facing_of(double normal_x, double normal_y) {
  const double turn = (std::atan2(normal_y, normal_x) + kPi) / (2.0 * kPi);
  return std::clamp(static_cast<int>(turn * kFacings), 0, kFacings - 1);
}

std::uint64_t key_of(double x_m, double y_m, int facing) {
  constexpr std::int64_t kOffset = 1 << 24;
  const auto ix = static_cast<std::int64_t>(std::floor(x_m / kVoxelM)) + kOffset;
  const auto iy = static_cast<std::int64_t>(std::floor(y_m / kVoxelM)) + kOffset;
  return (static_cast<std::uint64_t>(ix) << 32U) | (static_cast<std::uint64_t>(iy) << 4U) |
         static_cast<std::uint64_t>(facing);
}

struct Seen {
  CloudSurface surface;
  double range_sq;
  int last_keyframe;
  int sightings;
};
using Voxels = std::unordered_map<std::uint64_t, Seen>;

void add_keyframe(const Memory& memory, std::size_t k, Voxels& voxels) {
  const Transform2<Map, Base>& pose = memory.poses()[k];
  const SurfaceScan& scan = *memory.keyframes()[k].scan;
  for (const SurfacePoint& p : scan.points) {
    if (!p.has_normal()) {
      continue;
    }
    const SurfacePoint q = moved(pose, p);
    const CloudSurface surface{q.x_m, q.y_m, q.normal_x, q.normal_y, static_cast<int>(k)};
    const int seer = static_cast<int>(k);
    const double dx = p.x_m - scan.sensor.x_m;
    const double dy = p.y_m - scan.sensor.y_m;
    const double range_sq = dx * dx + dy * dy;
    const int facing = facing_of(surface.normal_x, surface.normal_y);
    const auto [at, fresh] =
        voxels.try_emplace(key_of(surface.x_m, surface.y_m, facing), Seen{surface, range_sq, seer, 1});
    if (fresh) {
      continue;
    }
    Seen& seen = at->second;
    seen.sightings += seen.last_keyframe == seer ? 0 : 1;
    seen.last_keyframe = seer;
    if (range_sq < seen.range_sq) {
      seen.surface = surface;
      seen.range_sq = range_sq;
    }
  }
}

/// Share of the metre to each side along the surface where the same surface runs on.
double straightness(const CloudSurface& p, const Voxels& voxels) {
  constexpr int kSteps = 5;
  const int facing = facing_of(p.normal_x, p.normal_y);
  int found = 0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double t = i * kVoxelM;
    found +=
        i != 0 && voxels.contains(key_of(p.x_m - p.normal_y * t, p.y_m + p.normal_x * t, facing)) ? 1 : 0;
  }
  return found / (2.0 * kSteps);
}

}  // namespace

MemoryCloud memory_cloud(const Memory& memory, std::size_t first, std::size_t end) {
  Voxels voxels;
  voxels.reserve(8192);
  for (std::size_t k = first; k < std::min(end, memory.size()); ++k) {
    add_keyframe(memory, k, voxels);
  }
  std::vector<std::pair<std::uint64_t, CloudSurface>> sorted;
  sorted.reserve(voxels.size());
  for (const auto& [key, seen] : voxels) {
    CloudSurface p = seen.surface;
    p.weight = std::max(0.1, straightness(p, voxels));
    p.direction = WallIndex::direction_of(p.normal_x, p.normal_y);
    p.sightings = seen.sightings;
    sorted.emplace_back(key, p);
  }
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  MemoryCloud cloud;
  cloud.reserve(sorted.size());
  for (const auto& entry : sorted) {
    cloud.push_back(entry.second);
  }
  return cloud;
}

MemoryCloud moved(const MemoryCloud& cloud, const Transform2<Map, Map>& by) {
  MemoryCloud out = cloud;
  for (CloudSurface& p : out) {
    const SurfacePoint q = moved(by, SurfacePoint{p.x_m, p.y_m, p.normal_x, p.normal_y});
    p.x_m = q.x_m, p.y_m = q.y_m;
    p.normal_x = q.normal_x, p.normal_y = q.normal_y;
    p.direction = WallIndex::direction_of(p.normal_x, p.normal_y);
  }
  return out;
}

}  // namespace madori::localization
