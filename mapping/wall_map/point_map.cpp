#include "mapping/wall_map/point_map.hpp"

#include <pcl/filters/voxel_grid.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

void sample(const Segment2<Map>& wall, double spacing_m, Cloud& cloud) {
  const auto steps = static_cast<int>(std::ceil(wall.length_m() / spacing_m));
  for (int i = 0; i <= steps; ++i) {
    const double share = steps == 0 ? 0.0 : static_cast<double>(i) / steps;
    cloud.emplace_back(static_cast<float>(wall.a.x_m + share * (wall.b.x_m - wall.a.x_m)),
                       static_cast<float>(wall.a.y_m + share * (wall.b.y_m - wall.a.y_m)), 0.0F);
  }
}

/// Walls of a mistaken scale are hundreds of kilometres long: they must not take the computer's memory.
void check_length(const Walls& walls, double spacing_m) {
  constexpr double kMostPoints = 20e6;
  double length_m = 0.0;
  for (const auto& wall : walls) length_m += wall.segment.length_m();
  if (!(length_m / spacing_m < kMostPoints))
    throw Error("walls of " + std::to_string(std::llround(std::min(length_m, 1e15))) + " m in all",
                "are too long for points " + std::to_string(spacing_m) + " m apart",
                "check the scale; where it is right, import the drawing anew with a wider point spacing");
}

/// PCL numbers voxels in 32 bits and would silently pass everything through beyond that.
void check_voxels(const Cloud& cloud, double voxel_m) {
  float low_x = std::numeric_limits<float>::max(), low_y = low_x, high_x = -low_x, high_y = -low_x;
  for (const auto& p : cloud) {
    low_x = std::min(low_x, p.x), high_x = std::max(high_x, p.x);
    low_y = std::min(low_y, p.y), high_y = std::max(high_y, p.y);
  }
  const double voxels = ((high_x - low_x) / voxel_m + 1.0) * ((high_y - low_y) / voxel_m + 1.0);
  if (voxels > std::numeric_limits<std::int32_t>::max())
    throw Error("the voxel grid", "is too fine for a drawing of this size",
                "check the scale; where it is right, import the drawing anew with larger voxels");
}

}  // namespace

PointMap make_point_map(const Walls& walls, double spacing_m, double voxel_m) {
  check_length(walls, spacing_m);
  const Cloud::Ptr cloud(new Cloud);
  for (const auto& wall : walls) sample(wall.segment, spacing_m, *cloud);
  PointMap map;
  map.sampled = cloud->size();
  if (cloud->empty()) return map;
  check_voxels(*cloud, voxel_m);
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  const auto leaf = static_cast<float>(voxel_m);
  grid.setLeafSize(leaf, leaf, leaf);
  Cloud thinned;
  grid.filter(thinned);
  for (const auto& p : thinned) map.points.push_back({p.x, p.y});
  return map;
}

void save_pcd(const std::filesystem::path& file, const PointMap& map) {
  Cloud cloud;
  for (const auto& p : map.points)
    cloud.emplace_back(static_cast<float>(p.x_m), static_cast<float>(p.y_m), 0.0F);
  cloud.width = static_cast<std::uint32_t>(cloud.size());
  cloud.height = 1;
  bool good = false;
  try {
    good = pcl::io::savePCDFileBinary(file.string(), cloud) == 0;
  } catch (const pcl::IOException&) {
  }
  if (!good) throw Error(file.string(), "cannot be written", "check the folder and its free space");
}

}  // namespace madori::mapping
