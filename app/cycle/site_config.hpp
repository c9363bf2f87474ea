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

/// Loads a scaled site with its routes; throws Error with the mend where something is missing or faulty: no
/// scale, no routes, no lidar that can be driven by.
[[nodiscard]] SiteForDriving load_for_driving(const std::filesystem::path& folder);

/// Other routes for a configuration whose walls and vehicle are known.
void take_routes(planning::RouteGraph routes, CycleConfig& config);

}  // namespace madori::app
