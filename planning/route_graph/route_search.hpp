#pragma once

#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "planning/route_graph/route_graph.hpp"

namespace madori::planning {

/// Hops: fewest legs, breadth-first as published (layout-map paper, section 3.3.1). Metres: shortest way.
enum class RouteMetric { Hops, Metres };

/// Legs that are left out, as (from, to) of RouteGraph::nodes().
using BlockedLegs = std::set<std::pair<std::size_t, std::size_t>>;

/// A longer way is none: no factory has it, and twice this is the longest path of waypoints
/// (waypoints.hpp) at the usual spacing.
inline constexpr double kLongestRouteM = 100'000.0;

struct Route {
  std::vector<std::size_t> nodes;  ///< of RouteGraph::nodes(), with both ends
  double length_m = 0.0;
};

/// The best way; among ways of equally few legs the one that the file lists first. Fails, with a reason for
/// the operator, where there is none, or where it is longer than kLongestRouteM. Preconditions: `from` and
/// `to` are nodes of the graph.
[[nodiscard]] Result<Route> find_route(const RouteGraph& graph, std::size_t from, std::size_t to,
                                       RouteMetric metric = RouteMetric::Hops,
                                       const BlockedLegs& blocked = {});

/// For each node the number of its strongly connected component, and the number of the largest one.
struct RouteComponents {
  std::vector<std::size_t> component;
  std::size_t largest = 0;
};
[[nodiscard]] RouteComponents strong_components(const RouteGraph& graph);
/// Whether each node can be reached from `from`.
[[nodiscard]] std::vector<bool> reachable_from(const RouteGraph& graph, std::size_t from);

}  // namespace madori::planning
