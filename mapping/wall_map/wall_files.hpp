#pragma once

#include "mapping/site/site_transaction.hpp"
#include "mapping/wall_map/point_map.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {

/// How finely the walls are written; lengths in the walls' own unit (metres, pixels while unscaled).
struct WallFileOptions {
  double point_spacing = 0.02;  ///< of the samples along a wall
  double voxel = 0.05;          ///< of walls.pcd
  double cell = 0.05;           ///< of map.pgm

  [[nodiscard]] static WallFileOptions unscaled() { return {1.0, 2.0, 2.0}; }
};

/// Stages walls.csv, walls.pcd, map.pgm and map.yaml of a drawing of `width` x `height`; the points of
/// walls.pcd.
PointMap stage_wall_files(SiteTransaction& change, const Walls& walls, double width, double height,
                          const WallFileOptions& options);

/// What else is drawn, as `walls.csv`: lines that were not taken for walls, and may be of things that stand
/// there. A map by driving has none.
inline constexpr const char* kOtherLinesFile = "other_lines.csv";
/// Of a site; none where the file is missing. Throws Error as load_walls does.
[[nodiscard]] Walls load_other_lines(const std::filesystem::path& site);

/// Lines in another unit.
void scale_walls(Walls& walls, double factor);

}  // namespace madori::mapping
