#include "planning/route_graph/route_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "core/fill_in.hpp"
#include "core/segment_distance.hpp"
#include "planning/route_graph/finding_texts.hpp"
#include "planning/route_graph/route_search.hpp"
#include "planning/route_graph/vehicle_fit.hpp"

namespace madori::planning {
namespace {

constexpr double kSameSpotM = 0.05;

std::string id_of(const RouteGraph& graph, std::size_t node) {
  return std::to_string(graph.nodes()[node].id);
}

/// The values that name a leg, and more.
std::map<std::string, std::string> of_leg(const RouteGraph& graph, const RouteLeg& leg,
                                          std::map<std::string, std::string> more = {}) {
  more.insert({{"from", id_of(graph, leg.from)}, {"to", id_of(graph, leg.to)}});
  return more;
}

/// Each leg once, also where it is two-way.
bool is_second_direction(const RouteGraph& graph, const RouteLeg& leg) {
  return leg.to < leg.from && graph.has_leg(leg.to, leg.from);
}

/// From the way between two nodes to the nearest wall; infinite where that is half the vehicle's width or
/// more.
double nearest_wall_m(const RouteGraph& graph, std::size_t from, std::size_t to, const WallGrid& walls,
                      const RouteCheckOptions& options) {
  const Segment2<Map> way{graph.nodes()[from].position, graph.nodes()[to].position};
  const Point2<Map> middle{(way.a.x_m + way.b.x_m) / 2.0, (way.a.y_m + way.b.y_m) / 2.0};
  const double near_m = options.vehicle.half_width_m;
  double nearest_m = std::numeric_limits<double>::infinity();
  walls.any_near(middle, way.length_m() / 2.0 + near_m, [&](const Segment2<Map>& wall) {
    nearest_m = std::min(nearest_m, distance_m(way, wall));
    return nearest_m == 0.0;
  });
  return nearest_m < near_m ? nearest_m : std::numeric_limits<double>::infinity();
}

void check_walls(const RouteGraph& graph, const WallGrid& walls, const RouteCheckOptions& options,
                 std::vector<RouteFinding>& findings) {
  for (const RouteLeg& leg : graph.legs()) {
    if (is_second_direction(graph, leg)) continue;
    const double nearest_m = nearest_wall_m(graph, leg.from, leg.to, walls, options);
    if (nearest_m == 0.0)
      findings.push_back(
          finding(Fault::ThroughWall, Severity::Error, options.tree_file, leg.line, of_leg(graph, leg)));
    else if (std::isfinite(nearest_m))
      findings.push_back(finding(Fault::NarrowAtWall, Severity::Warning, options.tree_file, leg.line,
                                 of_leg(graph, leg,
                                        {{"distance", two_decimals(nearest_m)},
                                         {"half", two_decimals(options.vehicle.half_width_m)}})));
  }
}

/// Each node once, however many ways lead round it.
void check_corners(const RouteGraph& graph, const WallGrid& walls, const RouteCheckOptions& options,
                   std::vector<RouteFinding>& findings) {
  std::set<std::pair<std::size_t, bool>> said;
  for (const TightCorner& corner : tight_corners(graph, walls, options.vehicle)) {
    const bool about = corner.from == corner.to;
    const RouteNode& node = graph.nodes()[corner.node];
    if (std::isfinite(nearest_wall_m(graph, corner.from, corner.node, walls, options)) ||
        std::isfinite(nearest_wall_m(graph, corner.node, corner.to, walls, options)))
      continue;  // check_walls says so
    if (!said.insert({corner.node, about}).second) continue;
    std::map<std::string, std::string> values{
        {"node", id_of(graph, corner.node)},
        {"length", two_decimals(options.vehicle.front_m + options.vehicle.rear_m)}};
    if (!about) values.insert({{"from", id_of(graph, corner.from)}, {"to", id_of(graph, corner.to)}});
    findings.push_back(finding(about ? Fault::NoTurnAbout : Fault::TightCorner,
                               about ? Severity::Warning : Severity::Error, options.path_file, node.line,
                               std::move(values)));
  }
}

void check_reachability(const RouteGraph& graph, const RouteCheckOptions& options,
                        std::vector<RouteFinding>& findings) {
  if (graph.nodes().empty()) return;
  const auto [component, largest] = strong_components(graph);
  const auto hub =
      static_cast<std::size_t>(std::find(component.begin(), component.end(), largest) - component.begin());
  const auto reached = reachable_from(graph, hub);
  for (const std::size_t station : graph.stations()) {
    if (component[station] == largest) continue;
    const RouteNode& node = graph.nodes()[station];
    findings.push_back(finding(reached[station] ? Fault::NoWayBack : Fault::OutOfReach, Severity::Error,
                               options.path_file, node.line, {{"node", id_of(graph, station)}}));
  }
}

void check_spots(const RouteGraph& graph, const RouteCheckOptions& options,
                 std::vector<RouteFinding>& findings) {
  for (const RouteLeg& leg : graph.legs())
    if (leg.length_m < kSameSpotM && !is_second_direction(graph, leg))
      findings.push_back(finding(Fault::ShortLeg, Severity::Warning, options.path_file,
                                 graph.nodes()[leg.to].line,
                                 of_leg(graph, leg, {{"length", two_decimals(leg.length_m)}})));
}

}  // namespace

std::vector<RouteFinding> one_way_warnings(const RouteGraph& graph, const std::string& tree_file) {
  std::vector<RouteFinding> findings;
  for (const RouteLeg& leg : graph.one_way_legs())
    findings.push_back(finding(Fault::OneWay, Severity::Warning, tree_file, leg.line, of_leg(graph, leg)));
  return findings;
}

std::vector<RouteFinding> check_routes(const RouteGraph& graph, const std::vector<Segment2<Map>>& walls,
                                       const RouteCheckOptions& options) {
  std::vector<RouteFinding> findings = one_way_warnings(graph, options.tree_file);
  const WallGrid grid(walls);
  check_walls(graph, grid, options, findings);
  check_corners(graph, grid, options, findings);
  check_reachability(graph, options, findings);
  check_spots(graph, options, findings);
  return findings;
}

}  // namespace madori::planning
