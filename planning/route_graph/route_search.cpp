#include "planning/route_graph/route_search.hpp"

#include <algorithm>
#include <boost/graph/breadth_first_search.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <boost/graph/strong_components.hpp>
#include <string>

namespace madori::planning {
namespace {

struct Weight {
  double length_m = 0.0;
};
using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, Weight>;
using Vertex = boost::graph_traits<Graph>::vertex_descriptor;

/// Legs of the routes are sorted by their beginning already, which is the order that this graph wants.
Graph boost_graph(const RouteGraph& routes, const BlockedLegs& blocked) {
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  std::vector<Weight> weights;
  edges.reserve(routes.legs().size());
  weights.reserve(routes.legs().size());
  for (const RouteLeg& leg : routes.legs()) {
    if (blocked.contains({leg.from, leg.to})) continue;
    edges.emplace_back(leg.from, leg.to);
    weights.push_back({leg.length_m});
  }
  return {boost::edges_are_sorted, edges.begin(), edges.end(), weights.begin(), routes.nodes().size()};
}

std::vector<Vertex> breadth_first(const Graph& graph, std::size_t from) {
  std::vector<Vertex> parent(num_vertices(graph));
  for (Vertex v = 0; v < parent.size(); ++v) parent[v] = v;
  const auto record = boost::record_predecessors(parent.data(), boost::on_tree_edge());
  boost::breadth_first_search(graph, from, boost::visitor(boost::make_bfs_visitor(record)));
  return parent;
}

std::vector<Vertex> shortest(const Graph& graph, std::size_t from) {
  std::vector<Vertex> parent(num_vertices(graph));
  boost::dijkstra_shortest_paths(
      graph, from, boost::predecessor_map(parent.data()).weight_map(get(&Weight::length_m, graph)));
  return parent;
}

}  // namespace

Result<Route> find_route(const RouteGraph& routes, std::size_t from, std::size_t to, RouteMetric metric,
                         const BlockedLegs& blocked) {
  const Graph graph = boost_graph(routes, blocked);
  const auto parent = metric == RouteMetric::Hops ? breadth_first(graph, from) : shortest(graph, from);
  Route route;
  route.nodes.reserve(routes.nodes().size());
  for (std::size_t at = to; at != from; at = parent[at]) {
    if (parent[at] == at)
      return Result<Route>::failure("no way leads from node " + std::to_string(routes.nodes()[from].id) +
                                    " to node " + std::to_string(routes.nodes()[to].id) +
                                    (blocked.empty() ? "" : " while legs are blocked"));
    route.length_m += distance_m(routes.nodes()[at].position, routes.nodes()[parent[at]].position);
    route.nodes.push_back(at);
  }
  if (!(route.length_m <= kLongestRouteM))
    return Result<Route>::failure("the way from node " + std::to_string(routes.nodes()[from].id) +
                                  " to node " + std::to_string(routes.nodes()[to].id) +
                                  " is longer than 100 km: correct the places of its nodes");
  route.nodes.push_back(from);
  std::reverse(route.nodes.begin(), route.nodes.end());
  return route;
}

RouteComponents strong_components(const RouteGraph& routes) {
  const Graph graph = boost_graph(routes, {});
  RouteComponents result;
  result.component.resize(routes.nodes().size());
  const std::size_t count = boost::strong_components(
      graph, boost::make_iterator_property_map(result.component.begin(), get(boost::vertex_index, graph)));
  std::vector<std::size_t> size(count);
  for (const std::size_t c : result.component) ++size[c];
  result.largest = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
  return result;
}

std::vector<bool> reachable_from(const RouteGraph& routes, std::size_t from) {
  const auto parent = breadth_first(boost_graph(routes, {}), from);
  std::vector<bool> reached(parent.size());
  for (Vertex v = 0; v < parent.size(); ++v) reached[v] = v == from || parent[v] != v;
  return reached;
}

}  // namespace madori::planning
