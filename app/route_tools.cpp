#include "app/route_tools.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace madori::app {

std::optional<std::string> node_name(const planning::RouteGraph& graph, int id) {
  const auto index = graph.index_of(id);
  if (!index) return std::nullopt;
  const auto& node = graph.nodes()[*index];
  return node.name.empty() ? std::to_string(id) : node.name;
}

std::vector<int> node_ids(const planning::RouteGraph& graph) {
  std::vector<int> ids;
  for (const auto& node : graph.nodes()) ids.push_back(node.id);
  return ids;
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

std::vector<std::size_t> nodes_near(const planning::RouteGraph& graph, const Point2<Map>& here) {
  constexpr std::size_t kNearest = 6;
  const auto& nodes = graph.nodes();
  std::vector<std::size_t> order(nodes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return distance_m(nodes[i].position, here); });
  order.resize(std::min(order.size(), kNearest));
  return order;
}

std::vector<std::size_t> main_routes(const planning::RouteGraph& graph) {
  std::vector<std::size_t> nodes;
  if (graph.nodes().empty()) return nodes;
  const auto [component, largest] = planning::strong_components(graph);
  for (std::size_t i = 0; i < component.size(); ++i)
    if (component[i] == largest) nodes.push_back(i);
  return nodes;
}

std::optional<int> stop_without_way(const planning::RouteGraph& graph, std::vector<std::size_t> starts,
                                    const std::vector<int>& stops, bool repeated) {
  std::vector<int> all = stops;
  if (repeated && !stops.empty()) all.push_back(stops.front());
  for (const int stop : all) {
    const auto goal = graph.index_of(stop);
    if (!goal) return std::nullopt;
    const auto leads = [&](std::size_t start) -> bool {
      return planning::reachable_from(graph, start)[*goal];
    };
    if (std::ranges::none_of(starts, leads)) return stop;
    starts = {*goal};
  }
  return std::nullopt;
}

}  // namespace madori::app
