#pragma once

#include <string>

#include "app/landmarks/corridor_run.hpp"

namespace madori::app {

/// One line a sighting and landmark: error and sigma, full and published form, and the agent beside odometry
/// alone.
[[nodiscard]] std::string corridor_csv(const CorridorRun& run);
/// SVG: position error and 2 sigma of every landmark over the sightings, as figure 9 of the paper, and below
/// it the error of the agent and of odometry alone.
[[nodiscard]] std::string corridor_figure(const CorridorRun& run);

}  // namespace madori::app
