#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "planning/route_graph/route_csv.hpp"
#include "planning/route_graph/route_graph.hpp"

/// What the site_editor*.cpp share.
namespace madori::hmi {

[[nodiscard]] bool has_site(const std::filesystem::path& folder);
/// None where there is no site yet.
[[nodiscard]] std::vector<Segment2<Map>> drawn_walls(const std::filesystem::path& folder);
/// What is wrong with routes on the site's drawing, for its vehicle.
[[nodiscard]] std::vector<planning::RouteFinding> findings_of(const std::filesystem::path& folder,
                                                              const planning::RouteGraph& graph);
/// Whom to name for the aerial photographs of a `tiles` folder; empty without.
[[nodiscard]] std::string attribution_of(const std::filesystem::path& tiles);

}  // namespace madori::hmi
