#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::app {

/// The occupied places of a map, metres, in the map's own frame, at most one a cell of `cell_m`. Read from a
/// walls.csv, a ROS map_server file (map.yaml and its picture), a living map, or a site folder, of which
/// walls.csv is taken. Throws Error.
[[nodiscard]] std::vector<Point2<Map>> occupied_places(const std::filesystem::path& file, double cell_m);

enum class MapAlignment {
  None,      ///< both are in one frame
  Near,      ///< the map lies within a metre and 12 degrees of where `start` says
  Anywhere,  ///< nothing is known of how it lies
};

struct MapComparisonOptions {
  double cell_m = 0.05;
  MapAlignment alignment = MapAlignment::Near;
  Transform2<Map, Map> start;  ///< building from map
};

/// How well a map shows a building (Santos, Portugal and Rocha 2013, as the lifelong-localization
/// source, 6.5.1, cites it): distance of each occupied place of the one to the nearest of the other, both
/// ways, after the map was laid on the building rigidly. What is missing in the map shows in building_to_map,
/// what is too much in map_to_building. Metres.
[[nodiscard]] nlohmann::json compare_maps(const std::vector<Point2<Map>>& map,
                                          const std::vector<Point2<Map>>& building,
                                          const MapComparisonOptions& options = {});

}  // namespace madori::app
