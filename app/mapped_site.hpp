#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "localization/drawing_fit/memory_cloud.hpp"
#include "mapping/site/site.hpp"
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

/// What site.yaml says beside the map, and what else is written with it. A site that is replaced keeps its
/// own vehicle and lidars.
struct MappedFor {
  std::string name;
  std::string source;  ///< the log or drive that it was made of
  mapping::VehicleRecord vehicle{};
  std::vector<mapping::SensorRecord> sensors{};
  std::map<std::string, std::string> files{};  ///< name in the site -> content
};

/// Writes the site folder in one atomic step: walls.csv, walls.pcd, map.pgm, map.yaml, drawing.png (what was
/// seen), import.png (the walls over it), site.yaml, and `whom.files`. Routes and all else that lay on a map
/// that is replaced go with it (its versions keep them). Throws Error.
void save_mapped_site(const MappedSite& mapped, const std::filesystem::path& folder, const MappedFor& whom);

}  // namespace madori::app
