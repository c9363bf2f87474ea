#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/path.hpp"
#include "core/result.hpp"
#include "planning/route_graph/route_search.hpp"
#include "planning/waypoints/waypoints.hpp"

namespace madori::app {

/// The name of a node, its number where it has none; nothing for one that is not there.
[[nodiscard]] std::optional<std::string> node_name(const planning::RouteGraph& graph, int id);

/// The corners of a route with the speed limit of the leg that leads to each.
[[nodiscard]] std::vector<planning::WayCorner> way_corners(const planning::RouteGraph& graph,
                                                           const planning::Route& route);

/// The waypoints of a route; a leg's speed limit is the smaller one of its ends, the final heading that of
/// the last node. Fails where the route is a single node.
[[nodiscard]] Result<Path> route_path(const planning::RouteGraph& graph, const planning::Route& route,
                                      const planning::WaypointOptions& options);

}  // namespace madori::app
