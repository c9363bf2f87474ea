#pragma once

#include <string>

#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {

/// The walls in the format of ROS map_server (map.pgm, map.yaml), so that nav2 and others can use a site.
struct OccupancyMap {
  std::string pgm;  ///< 8-bit P5; 0 wall, 254 free
  std::string yaml;
};

/// Covers the drawing, [0, width_m] x [0, height_m], in cells of `cell_m`. Throws Error beyond 100 million
/// cells.
[[nodiscard]] OccupancyMap make_occupancy_map(const Walls& walls, double width_m, double height_m,
                                              double cell_m);

}  // namespace madori::mapping
