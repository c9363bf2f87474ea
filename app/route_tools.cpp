#include "app/route_tools.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace madori::app {

Result<Path> route_path(const planning::RouteGraph& graph, const planning::Route& route,
                        const planning::WaypointOptions& options) {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  std::vector<planning::WayCorner> way;
  double previous_limit = kNoLimit;
  for (const std::size_t index : route.nodes) {
    const planning::RouteNode& node = graph.nodes()[index];
    const double limit = node.speed_limit_mps.value_or(kNoLimit);
    way.push_back({node.position, std::min(limit, previous_limit)});
    previous_limit = limit;
  }
  return planning::make_waypoints(way, options, graph.nodes()[route.nodes.back()].heading_rad);
}

}  // namespace madori::app
