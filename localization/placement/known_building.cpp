#include "localization/placement/known_building.hpp"

#include <cmath>

namespace madori::localization {
namespace {

constexpr double kSameWallM = 0.2;  ///< a voxel: as near as a memory tells surfaces apart

/// The walls, and what was seen beside them: furniture, racks, walls that nobody drew. Those from where they
/// were seen; they are nobody's other face.
DrawingFit with_seen_beside(const WallIndex& drawn, const Memory& memory) {
  mapping::Walls all = drawn.walls();
  std::vector<VisibleFace> faces = visible_faces(all);
  for (const CloudSurface& p : memory_cloud(memory)) {
    const WallIndex::Hit hit = drawn.nearest(p.x_m, p.y_m, p.direction);
    if (hit.wall >= 0 && std::abs(hit.distance_m) < kSameWallM && hit.beyond_m < kSameWallM) continue;
    const double half_x = 0.5 * kVoxelM * p.normal_y, half_y = -0.5 * kVoxelM * p.normal_x;
    all.push_back({static_cast<int>(all.size()) + 1,
                   {{p.x_m - half_x, p.y_m - half_y}, {p.x_m + half_x, p.y_m + half_y}}});
    faces.push_back({{{{0.0, kVoxelM}}, {}}});  // its normal is the left one
  }
  return {all, faces};
}

}  // namespace

KnownBuilding::KnownBuilding(const DrawingFit& standing, const Memory& memory)
    : walls(with_seen_beside(standing.index(), memory)), crossings(memory) {}

}  // namespace madori::localization
