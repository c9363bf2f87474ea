#pragma once

#include <filesystem>

#include "app/cycle/cycle.hpp"
#include "mapping/site/site.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

/// Everything that the cycle needs of a site folder.
struct SiteForDriving {
  mapping::Site site;
  mapping::Walls walls;
  CycleConfig config;
};

/// What a vehicle and its lidars mean for the cycle; routes and walls stay empty.
[[nodiscard]] CycleConfig vehicle_config(const mapping::VehicleRecord& vehicle,
                                         std::vector<LidarModel> lidars);

/// Loads a scaled site with its routes; throws Error with the mend where something is missing or faulty: no
/// scale, no routes, no lidar that can be driven by. All files are of one state of the site.
[[nodiscard]] SiteForDriving load_for_driving(const std::filesystem::path& folder);

/// The same of a vehicle that is about to map by driving: no routes, no walls, and a silent lidar forbids to
/// move by hand, too, for what is driven blind is a hole in the map. `where`: the folder of what is wrong.
[[nodiscard]] CycleConfig config_for_mapping(const mapping::Site& setup, const std::filesystem::path& where);
/// Other routes for a configuration whose walls and vehicle are known.
void take_routes(planning::RouteGraph routes, CycleConfig& config);

}  // namespace madori::app
