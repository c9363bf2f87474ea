#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "localization/ndt_map/hybrid_map.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

inline constexpr const char* kLivingMapFile = "learned/living_map.bin";

/// A living map by itself, whatever walls it lies on. Throws Error where it is missing or damaged.
[[nodiscard]] localization::HybridMap load_living_map(const std::filesystem::path& file);

/// What earlier drives kept with a site, with these walls and what else the site's drawing shows drawn into
/// it, also where walls were edited since; an empty one where nothing usable is kept, with the reason in
/// `message` where there is one. What a clock that was ahead has stamped later than now counts as seen now.
struct LivingMap {
  localization::HybridMap map;
  std::string message;
};
[[nodiscard]] LivingMap begin_living_map(const std::filesystem::path& site, const mapping::Walls& walls);

/// Writes the file atomically, and its folder where there is none. Throws Error (disk full, no permission).
void save_living_map(const std::filesystem::path& site, const localization::HybridMap& map,
                     const mapping::Walls& walls);

/// Where something stands, static or semi-static: the means of those cells.
[[nodiscard]] std::vector<Point2<Map>> standing_places(const localization::HybridMap& map);

}  // namespace madori::app
