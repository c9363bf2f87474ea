// Searches on random graphs against the enumeration of every simple way.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "planning/route_graph/route_search.hpp"
#include "planning/waypoints/waypoints.hpp"

namespace madori::planning {
namespace {

struct Best {
  std::size_t hops = std::numeric_limits<std::size_t>::max();
  double metres = std::numeric_limits<double>::infinity();
};

void every_way(const RouteGraph& graph, std::size_t at, std::size_t to, std::vector<bool>& visited,
               std::size_t hops, double metres, const BlockedLegs& blocked, Best& best) {
  if (at == to) {
    best.hops = std::min(best.hops, hops);
    best.metres = std::min(best.metres, metres);
    return;
  }
  visited[at] = true;
  for (const RouteLeg& leg : graph.legs())
    if (leg.from == at && !visited[leg.to] && !blocked.contains({leg.from, leg.to}))
      every_way(graph, leg.to, to, visited, hops + 1, metres + leg.length_m, blocked, best);
  visited[at] = false;
}

RouteGraph random_graph() {
  const auto count = *rc::gen::inRange<std::size_t>(2, 7);
  std::vector<RouteNode> nodes(count);
  for (std::size_t i = 0; i < count; ++i) {
    nodes[i].id = static_cast<int>(i) * 3;
    nodes[i].position = {*rc::gen::inRange(-100, 100) / 7.0, *rc::gen::inRange(-100, 100) / 7.0};
  }
  std::vector<RouteLeg> legs;
  for (std::size_t from = 0; from < count; ++from)
    for (std::size_t to = 0; to < count; ++to)
      if (from != to && *rc::gen::inRange(0, 3) == 0) legs.push_back({from, to, 0.0, 0});
  return {std::move(nodes), std::move(legs)};
}

/// Whether `route` goes from one end to the other over open legs and its length is the sum of theirs.
void expect_real(const RouteGraph& graph, const Route& route, std::size_t from, std::size_t to,
                 const BlockedLegs& blocked) {
  RC_ASSERT(route.nodes.front() == from && route.nodes.back() == to);
  double length_m = 0.0;
  for (std::size_t i = 0; i + 1 < route.nodes.size(); ++i) {
    RC_ASSERT(graph.has_leg(route.nodes[i], route.nodes[i + 1]));
    RC_ASSERT(!blocked.contains({route.nodes[i], route.nodes[i + 1]}));
    length_m +=
        distance_m(graph.nodes()[route.nodes[i]].position, graph.nodes()[route.nodes[i + 1]].position);
  }
  RC_ASSERT(std::abs(length_m - route.length_m) < 1e-9);
}

RC_GTEST_PROP(RouteSearchProperty, AgreesWithEveryWayEnumerated, ()) {
  const RouteGraph graph = random_graph();
  const std::size_t from = 0;
  const std::size_t to = graph.nodes().size() - 1;
  BlockedLegs blocked;
  if (!graph.legs().empty() && *rc::gen::arbitrary<bool>())
    blocked.insert({graph.legs().front().from, graph.legs().front().to});
  Best best;
  std::vector<bool> visited(graph.nodes().size());
  every_way(graph, from, to, visited, 0, 0.0, blocked, best);
  const auto hops = find_route(graph, from, to, RouteMetric::Hops, blocked);
  const auto metres = find_route(graph, from, to, RouteMetric::Metres, blocked);
  const bool reachable = best.hops != std::numeric_limits<std::size_t>::max();
  RC_ASSERT(hops.ok() == reachable && metres.ok() == reachable);
  if (!reachable) return;
  expect_real(graph, hops.value(), from, to, blocked);
  expect_real(graph, metres.value(), from, to, blocked);
  RC_ASSERT(hops.value().nodes.size() == best.hops + 1);
  RC_ASSERT(std::abs(metres.value().length_m - best.metres) < 1e-9);
}

RC_GTEST_PROP(WaypointsProperty, SpacingIsEvenAndNoWaypointLeavesTheWayFar, ()) {
  std::vector<WayCorner> way;
  const auto count = *rc::gen::inRange(2, 8);
  for (int i = 0; i < count; ++i)
    way.push_back({{*rc::gen::inRange(0, 200) / 10.0, *rc::gen::inRange(0, 200) / 10.0}});
  const WaypointOptions options;
  const auto made = make_waypoints(way, options);
  RC_PRE(made.ok());
  const auto& points = made.value().points;
  RC_ASSERT(distance_m(points.front().position, way.front().position) < 1e-9);
  RC_ASSERT(distance_m(points.back().position, way.back().position) < 1e-9);
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    RC_ASSERT(distance_m(points[i].position, points[i + 1].position) <= 1.5 * options.spacing_m + 1e-9);
  for (const auto& corner : way) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const auto& point : points)
      nearest_m = std::min(nearest_m, distance_m(point.position, corner.position));
    RC_ASSERT(nearest_m <= options.max_corner_cut_m + options.spacing_m);
  }
}

}  // namespace
}  // namespace madori::planning
