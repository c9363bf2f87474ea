#include "mapping/wall_map/wall_files.hpp"

#include "mapping/wall_map/occupancy_map.hpp"

namespace madori::mapping {

PointMap stage_wall_files(SiteTransaction& change, const Walls& walls, double width, double height,
                          const WallFileOptions& options) {
  PointMap points = make_point_map(walls, options.point_spacing, options.voxel);
  change.said_of_site([&] { save_pcd(change.staged("walls.pcd"), points); });
  const OccupancyMap grid = make_occupancy_map(walls, width, height, options.cell);
  change.write("map.pgm", grid.pgm);
  change.write("map.yaml", grid.yaml);
  change.write("walls.csv", walls_csv(walls));
  return points;
}

Walls load_other_lines(const std::filesystem::path& site) {
  const auto file = site / kOtherLinesFile;
  return std::filesystem::exists(file) ? load_walls(file) : Walls{};
}

void scale_walls(Walls& walls, double factor) {
  for (auto& wall : walls)
    for (Point2<Map>* p : {&wall.segment.a, &wall.segment.b}) *p = {p->x_m * factor, p->y_m * factor};
}

}  // namespace madori::mapping
