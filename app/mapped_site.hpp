#pragma once

#include <filesystem>
#include <string>

#include "localization/drawing_fit/memory_cloud.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

/// What was mapped, laid out like a drawing: the longest walls along the axes, the lower-left corner of the
/// picture at the Map origin.
struct MappedSite {
  Transform2<Map, Map> map_from_memory;  ///< moves poses of the memory onto the site
  mapping::Walls walls;
  localization::MemoryCloud cloud;
  int width_px = 0;
  int height_px = 0;

  static constexpr double kMetresPerPixel = 0.02;
};

/// Straight walls of the memory, turned and shifted onto a picture. Throws Error when there are none.
[[nodiscard]] MappedSite map_site(const localization::MemoryCloud& memory, const std::string& log);

/// Writes the site folder in one atomic step: walls.csv, walls.pcd, map.pgm, map.yaml, drawing.png (what was
/// seen), import.png (the walls over it), site.yaml. Throws Error.
void save_mapped_site(const MappedSite& mapped, const std::filesystem::path& folder, const std::string& name,
                      const std::string& log);

}  // namespace madori::app
