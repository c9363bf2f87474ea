#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::app {

/// A map in the format of ROS map_server: a picture and where it lies. Rows from the top, as in the picture.
struct GridMap {
  double cell_m = 0.05;
  Point2<Map> origin;    ///< of the lower-left pixel
  double yaw_rad = 0.0;  ///< of the picture about its origin
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;  ///< 0 occupied, 205 unknown, 254 free
  double occupied_over = 0.65;       ///< (255 - value) / 255 above it is occupied
  bool negate = false;               ///< white is occupied
};

/// Reads map.yaml and the 8-bit PGM (P5) or PNG beside it. Throws Error.
[[nodiscard]] GridMap load_grid_map(const std::filesystem::path& yaml);
/// Writes STEM.pgm and STEM.yaml, each atomically. Throws Error.
void save_grid_map(const std::filesystem::path& stem, const GridMap& map);
/// Centres of the occupied pixels.
[[nodiscard]] std::vector<Point2<Map>> occupied_cells(const GridMap& map);

}  // namespace madori::app
