#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {

/// The walls as points, the form in which the layout-map paper matches a lidar against them (section 3.1).
struct PointMap {
  std::vector<Point2<Map>> points;  ///< one a voxel: the mean of the samples in it
  std::size_t sampled = 0;          ///< before the voxel grid
};

/// Samples every wall at equal steps, both ends included, and thins the samples with pcl::VoxelGrid. A voxel
/// too fine for PCL's 32-bit indices, and walls that make over 20 million samples, are refused with an Error.
/// Lengths in the walls' own unit.
[[nodiscard]] PointMap make_point_map(const Walls& walls, double spacing_m, double voxel_m);

/// walls.pcd: binary, x y z float, z = 0. Throws Error when it cannot be written.
void save_pcd(const std::filesystem::path& file, const PointMap& map);

}  // namespace madori::mapping
