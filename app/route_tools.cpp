#include "app/route_tools.hpp"

#include <algorithm>
#include <limits>

namespace madori::app {

std::optional<std::string> node_name(const planning::RouteGraph& graph, int id) {
  const auto index = graph.index_of(id);
  if (!index) return std::nullopt;
  const auto& node = graph.nodes()[*index];
  return node.name.empty() ? std::to_string(id) : node.name;
}

std::vector<planning::WayCorner> way_corners(const planning::RouteGraph& graph,
                                             const planning::Route& route) {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  std::vector<planning::WayCorner> way;
  double previous_limit = kNoLimit;
  for (const std::size_t index : route.nodes) {
    const planning::RouteNode& node = graph.nodes()[index];
    const double limit = node.speed_limit_mps.value_or(kNoLimit);
    way.push_back({node.position, std::min(limit, previous_limit)});
    previous_limit = limit;
  }
  return way;
}

Result<Path> route_path(const planning::RouteGraph& graph, const planning::Route& route,
                        const planning::WaypointOptions& options) {
  return planning::make_waypoints(way_corners(graph, route), options,
                                  graph.nodes()[route.nodes.back()].heading_rad);
}

}  // namespace madori::app
