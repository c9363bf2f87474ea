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
/// scale, no routes, no lidar that can be driven by.
[[nodiscard]] SiteForDriving load_for_driving(const std::filesystem::path& folder);

}  // namespace madori::app
