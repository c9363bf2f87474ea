#include "mapping/wall_map/wall_files.hpp"

#include "mapping/wall_map/occupancy_map.hpp"

namespace madori::mapping {

PointMap stage_wall_files(SiteTransaction& change, const Walls& walls, double width, double height,
                          const WallFileOptions& options) {
  PointMap points = make_point_map(walls, options.point_spacing, options.voxel);
  save_pcd(change.staged("walls.pcd"), points);
  const OccupancyMap grid = make_occupancy_map(walls, width, height, options.cell);
  change.write("map.pgm", grid.pgm);
  change.write("map.yaml", grid.yaml);
  change.write("walls.csv", walls_csv(walls));
  return points;
}

}  // namespace madori::mapping
