#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "localization/memory/memory.hpp"

namespace madori::localization {

/// A piece of surface of the memory, Map frame, at most one every voxel and facing: a wall counts by its
/// length, not by how often it was seen.
struct CloudSurface {
  double x_m = 0.0;
  double y_m = 0.0;
  double normal_x = 0.0;
  double normal_y = 0.0;
  int keyframe = 0;       ///< whose sight of it counts: the one that saw it from the nearest
  int direction = 0;      ///< of its normal, WallIndex::direction_of
  int sightings = 1;      ///< keyframes that saw it
  double standing = 1.0;  ///< 0..1, share of the views of its place that met a surface there (standing_cloud)
  double weight = 0.0;    ///< 0..1, how long and straight the surface runs on: walls more than furniture
};
using MemoryCloud = std::vector<CloudSurface>;

inline constexpr double kVoxelM = 0.2;

/// The surfaces with a known normal of the keyframes [first, end). Deterministic: ordered by voxel.
[[nodiscard]] MemoryCloud memory_cloud(const Memory& memory, std::size_t first = 0,
                                       std::size_t end = std::numeric_limits<std::size_t>::max());
/// The same surfaces elsewhere.
[[nodiscard]] MemoryCloud moved(const MemoryCloud& cloud, const Transform2<Map, Map>& by);

}  // namespace madori::localization
