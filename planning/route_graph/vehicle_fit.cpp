#include "planning/route_graph/vehicle_fit.hpp"

#include <cmath>

namespace madori::planning {
namespace {

/// The point of the leg at most `reach_m` from the node `at`.
Point2<Map> near_end(const Point2<Map>& at, const Point2<Map>& towards, double reach_m) {
  const double length_m = distance_m(at, towards);
  const double share = length_m > reach_m ? reach_m / length_m : 1.0;
  return {at.x_m + share * (towards.x_m - at.x_m), at.y_m + share * (towards.y_m - at.y_m)};
}

/// Arriving at a node that asks for a heading, and leaving it from there.
Path turn_at(const Point2<Map>& at, double from_rad, double to_rad) {
  Path path;
  path.points.assign(2, PathPoint{at, from_rad});
  path.points.back().heading_rad = to_rad;
  return path;
}

double direction(const Point2<Map>& a, const Point2<Map>& b) {
  return std::atan2(b.y_m - a.y_m, b.x_m - a.x_m);
}

}  // namespace

PathCheck check_fit(const Path& path, const WallGrid& walls, const VehicleOutline& vehicle) {
  constexpr double kDrawnWithinM = 0.1;
  CheckOptions bare;
  bare.vehicle = vehicle;
  bare.wall_margin_m = -kDrawnWithinM;
  return check_path(path, 0, PathCheck::kFree, {}, walls, bare);
}

std::vector<TightCorner> tight_corners(const RouteGraph& graph, const WallGrid& walls,
                                       const VehicleOutline& vehicle, const WaypointOptions& options) {
  // So much of both legs decides how the corner is rounded, and what the vehicle sweeps in it.
  const double leg_m = 2.0 * options.corner_radius_m + vehicle.reach_m();
  std::vector<TightCorner> tight;
  const auto& nodes = graph.nodes();
  const auto look = [&](const TightCorner& corner, const Path& path) {
    const PathCheck check = check_fit(path, walls, vehicle);
    if (!check.blocked()) return;
    tight.push_back(corner);
    tight.back().wall = check.where;
  };
  for (const RouteLeg& in : graph.legs()) {
    const RouteNode& node = nodes[in.to];
    if (!walls.any_near(node.position, leg_m + vehicle.reach_m(), [](const auto&) { return true; })) continue;
    const Point2<Map> begin = near_end(node.position, nodes[in.from].position, leg_m);
    const auto ways_on = graph.legs_from(in.to);
    for (const RouteLeg& out : ways_on) {
      const bool turns_about = out.to == in.from;
      if (turns_about && !node.station && ways_on.size() > 1) continue;
      const Point2<Map> end = near_end(node.position, nodes[out.to].position, leg_m);
      const TightCorner corner{in.from, in.to, out.to, {}};
      if (node.heading_rad) {  // it stands so before it goes on
        look(corner, turn_at(node.position, direction(begin, node.position), *node.heading_rad));
        look(corner, turn_at(node.position, *node.heading_rad, direction(node.position, end)));
      }
      if (node.heading_rad && turns_about) continue;
      if (auto path = make_waypoints({{begin}, {node.position}, {end}}, options)) look(corner, path.value());
    }
  }
  return tight;
}

}  // namespace madori::planning
