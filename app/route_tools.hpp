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
/// Of all nodes.
[[nodiscard]] std::vector<int> node_ids(const planning::RouteGraph& graph);

/// The corners of a route with the speed limit of the leg that leads to each.
[[nodiscard]] std::vector<planning::WayCorner> way_corners(const planning::RouteGraph& graph,
                                                           const planning::Route& route);

/// The waypoints of a route; a leg's speed limit is the smaller one of its ends, the final heading that of
/// the last node. Fails where the route is a single node.
[[nodiscard]] Result<Path> route_path(const planning::RouteGraph& graph, const planning::Route& route,
                                      const planning::WaypointOptions& options);

/// The nodes nearest to a place, at most six: a vehicle there may begin its route at any of them.
[[nodiscard]] std::vector<std::size_t> nodes_near(const planning::RouteGraph& graph, const Point2<Map>& here);

/// The largest part of the routes in which every node leads to every other.
[[nodiscard]] std::vector<std::size_t> main_routes(const planning::RouteGraph& graph);

/// The first of these stops (IDs) that no way leads to: from any of `starts`, from each stop to the next, and
/// from the last to the first where they are `repeated`. Nothing where all can be reached; a stop that is not
/// in the routes is none of this function's business.
[[nodiscard]] std::optional<int> stop_without_way(const planning::RouteGraph& graph,
                                                  std::vector<std::size_t> starts,
                                                  const std::vector<int>& stops, bool repeated);

}  // namespace madori::app
