#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "app/grid_map_file.hpp"
#include "localization/ndt_map/hybrid_map.hpp"
#include "mapping/site/site.hpp"

namespace madori::app {

/// What of a living map is drawn as occupied.
enum class MapLayer {
  Static,      ///< what is permanent
  SemiStatic,  ///< what stands, but did not always
  Free,        ///< whatever is not free floor: both, what moves, and what was taken away is free again
};
[[nodiscard]] const char* to_string(MapLayer layer);

/// A layer as a map_server picture, a pixel a cell: 0 occupied, 254 seen and not occupied, 205 unseen.
[[nodiscard]] GridMap layer_of(const localization::HybridMap& map, MapLayer layer);

/// static, semi_static and free, each as .pgm and .yaml (map_server) and .tif (GeoTIFF, in the place on Earth
/// that the site has, else in Map metres) in `folder`. Throws Error.
void save_map_layers(const localization::HybridMap& map,
                     const std::optional<mapping::GeoreferenceRecord>& georeference,
                     const std::filesystem::path& folder);

/// Number of cells by state, and what the map takes.
[[nodiscard]] nlohmann::json to_json(const localization::HybridMap& map);

}  // namespace madori::app
