#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/path.hpp"
#include "localization/localizability/localizability.hpp"

namespace madori::app {

/// Where a place stands between well fixed and bare, by the expected sigma in its weakest direction.
enum class Fix { Good, Fair, Weak, Bare };
[[nodiscard]] Fix fix_of(const localization::Localizability& forecast);

/// The forecast along a route and over the floor around it.
struct LocalizabilityMap {
  std::vector<localization::Localizability> route;
  std::vector<localization::Localizability> floor;  ///< at the middles of squares
  double square_m = 1.0;
};

/// From the walls alone, as they are to be believed. The floor is what lies 0.3 m from every wall with walls
/// around it; squares of a metre, larger where that would be more than 4000. Takes about 0.1 ms a place.
[[nodiscard]] LocalizabilityMap forecast_localizability(const mapping::Walls& walls,
                                                        const std::vector<double>& weights, const Path& path,
                                                        const localization::ForecastLidar& lidar = {});

/// PNG bytes: the floor by fix, the route with the ellipses of the expected error (enlarged as the legend
/// says), bare stretches crossed.
[[nodiscard]] std::vector<std::uint8_t> localizability_plot(const mapping::Walls& walls,
                                                            const LocalizabilityMap& map);
/// A row a place of the route, and the weakest.
[[nodiscard]] nlohmann::json to_json(const LocalizabilityMap& map);
/// One line for people.
[[nodiscard]] std::string describe(const LocalizabilityMap& map);

}  // namespace madori::app
