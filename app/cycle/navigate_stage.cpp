#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include "app/cycle/stages.hpp"
#include "app/route_tools.hpp"
#include "core/segment_distance.hpp"

namespace madori::app {
namespace {

constexpr double kAtNodeM = 0.15;       ///< nearer than this the vehicle counts as standing on the node
constexpr double kOnLegM = 0.5;         ///< nearer than this the vehicle counts as standing on the leg
constexpr std::size_t kCandidates = 6;  ///< nodes that are tried as the first of a route

bool crosses_wall(const planning::WallGrid& walls, const Segment2<Map>& way) {
  const Point2<Map> middle{(way.a.x_m + way.b.x_m) / 2.0, (way.a.y_m + way.b.y_m) / 2.0};
  return walls.any_near(middle, way.length_m() / 2.0 + 0.01,
                        [&](const Segment2<Map>& wall) { return distance_m(wall, way) == 0.0; });
}

/// The ends of the legs that the vehicle stands on, as far as they may be driven to. Of a blocked leg that is
/// the end that the vehicle came from.
std::set<std::size_t> ends_of_own_legs(const planning::RouteGraph& routes, const Point2<Map>& here,
                                       const planning::BlockedLegs& blocked) {
  const auto& nodes = routes.nodes();
  std::set<std::size_t> ends;
  for (const auto& leg : routes.legs()) {
    if (distance_m(nodes[leg.from].position, here) < kAtNodeM) ends.insert(leg.from);
    const Segment2<Map> way{nodes[leg.from].position, nodes[leg.to].position};
    if (distance_m(way, here) < kOnLegM && !blocked.contains({leg.from, leg.to})) ends.insert(leg.to);
  }
  return ends;
}

/// Nodes that the vehicle could begin its route at: the ends of its own leg; off the routes the nearest nodes
/// that no drawn wall hides.
std::vector<std::size_t> first_nodes(const SiteInBuilding& site, const Point2<Map>& here,
                                     const planning::BlockedLegs& blocked) {
  const auto own = ends_of_own_legs(site.routes(), here, blocked);
  if (!own.empty()) return {own.begin(), own.end()};
  const auto& nodes = site.routes().nodes();
  std::vector<std::size_t> order(nodes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return distance_m(nodes[a].position, here) < distance_m(nodes[b].position, here);
  });
  std::vector<std::size_t> seen;
  for (const std::size_t node : order) {
    if (crosses_wall(*site.walls(), {here, nodes[node].position})) continue;
    seen.push_back(node);
    if (seen.size() == kCandidates) break;
  }
  return seen;
}

planning::BlockedLegs both_ways(planning::BlockedLegs blocked) {
  for (const auto& [from, to] : planning::BlockedLegs(blocked)) blocked.insert({to, from});
  return blocked;
}

/// The route to `goal` with the least way in all, the way to its first node counted.
std::optional<planning::Route> best_route(const SiteInBuilding& site, planning::RouteMetric metric,
                                          const Point2<Map>& here, std::size_t goal,
                                          const planning::BlockedLegs& blocked) {
  std::optional<planning::Route> best;
  double best_m = std::numeric_limits<double>::infinity();
  for (const std::size_t first : first_nodes(site, here, blocked)) {
    auto route = planning::find_route(site.routes(), first, goal, metric, both_ways(blocked));
    if (!route) continue;
    const double whole_m = route.value().length_m + distance_m(site.routes().nodes()[first].position, here);
    if (whole_m >= best_m) continue;
    best_m = whole_m;
    best = std::move(route).value();
  }
  return best;
}

/// The path from the vehicle over a route; a single point where it stands at the goal already. Fails where
/// the route is none that waypoints can be laid along.
Result<Path> path_over(const CycleState& state, const planning::Route& route, const CycleConfig& config) {
  const Transform2<Map, Base>& pose = state.pose.map_from_base;
  const Point2<Map> here = pose.translation();
  auto way = way_corners(state.site->routes(), route);
  if (way.size() == 1 || distance_m(way.front().position, here) > kAtNodeM)
    way.insert(way.begin(), {here, way.front().speed_limit_mps});
  else
    way.front().position = here;
  const auto& goal = state.site->routes().nodes()[route.nodes.back()];
  const bool near = distance_m(here, goal.position) < config.pursuit.goal_tolerance_m * 3.0;
  if (!near || way.size() != 2) {
    auto path = planning::make_waypoints(way, config.waypoints, goal.heading_rad);
    if (path || !near) return path;
  }
  Path there_already{{{here, pose.yaw_rad(), 0.0}}};
  if (goal.heading_rad) planning::end_in(there_already, *goal.heading_rad);
  return there_already;
}

void forget_errand(CycleState& state) {
  state.errand = {};
  state.way = {};
  state.progress = {};
  state.ahead = {};
  state.block = {};
  const std::uint32_t asked = state.detour.id;
  state.detour = {};
  state.detour.id = asked;  // a search that still runs does not answer the next errand's question
}

/// Whether a route leads round a corner that the vehicle's outline does not get round.
bool is_too_tight(const planning::Route& route, const std::vector<planning::TightCorner>& tight) {
  for (std::size_t i = 1; i + 1 < route.nodes.size(); ++i)
    for (const planning::TightCorner& corner : tight)
      if (corner.from == route.nodes[i - 1] && corner.node == route.nodes[i] &&
          corner.to == route.nodes[i + 1])
        return true;
  return false;
}

/// Nobody says on which side of its node a door is: the one at the other end of the leg on which the vehicle
/// stands may still lie ahead.
std::vector<std::size_t> doors_on(const planning::RouteGraph& routes, const planning::Route& route,
                                  const Point2<Map>& here) {
  const auto& nodes = routes.nodes();
  std::vector<std::size_t> way = route.nodes;
  if (distance_m(nodes[way.front()].position, here) >= kAtNodeM) {
    const auto ends = ends_of_own_legs(routes, here, {});
    way.insert(way.begin(), ends.begin(), ends.end());
  }
  std::erase_if(way, [&](std::size_t node) { return !planning::is_door(nodes[node].action); });
  return way;
}

void refuse(CycleState& state, Cause why, CycleOutput& output) {
  state.errand.no_way = notice(why, {{"node", std::to_string(state.errand.stop.node)}});
  output.order_refused = {state.errand.target->order, state.errand.no_way.text};
}

void plan(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output) {
  state.errand.arrived = state.errand.reported = false;
  state.way.path = {};
  state.way.plain = {};
  const auto goal = state.site->routes().index_of(state.errand.stop.node);
  if (!goal) return refuse(state, Cause::UnknownNode, output);
  const Point2<Map> here = state.pose.map_from_base.translation();
  auto route = best_route(*state.site, config.metric, here, *goal,
                          blocked_now(state.errand, input.now, config.forget_block_s));
  if (!route) {
    state.errand.blocked_legs.clear();  // every way is blocked: the vehicle goes to see whether it still is
    route = best_route(*state.site, config.metric, here, *goal, {});
  }
  if (!route) return refuse(state, Cause::NoWay, output);
  if (is_too_tight(*route, config.tight_corners)) return refuse(state, Cause::TooLongForWay, output);
  auto path = path_over(state, *route, config);
  if (!path) return refuse(state, Cause::NoWay, output);
  state.errand.nodes = route->nodes;
  state.errand.doors = doors_on(state.site->routes(), *route, here);
  state.detour.failed.clear();
  state.block.since.reset();
  take_path(state, std::move(path).value(), config);
}

/// A way around with a turn on the spot at its end where the goal has a heading: no curve ends in it exactly.
Path ending_as_asked(Path path, const CycleState& state) {
  const auto& routes = state.site->routes();
  const auto goal = routes.index_of(state.errand.stop.node);
  if (!goal || !routes.nodes()[*goal].heading_rad) return path;
  const auto& points = path.points;
  const bool turns = points.size() > 1 && points.back().position == points[points.size() - 2].position;
  if (!turns) planning::end_in(path, *routes.nodes()[*goal].heading_rad);
  return path;
}

/// What blocks the way; the vehicle's own place where it has no room to turn.
Point2<Map> place_of_block(const CycleState& state) {
  const auto& check = state.ahead.check;
  return check.blocked() ? check.where : state.pose.map_from_base.translation();
}

/// The leg of the route that is nearest to what blocks it.
std::optional<std::pair<std::size_t, std::size_t>> blocked_leg(const CycleState& state,
                                                               const Point2<Map>& block) {
  std::optional<std::pair<std::size_t, std::size_t>> leg;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < state.errand.nodes.size(); ++i) {
    const auto& nodes = state.site->routes().nodes();
    const Segment2<Map> piece{nodes[state.errand.nodes[i]].position,
                              nodes[state.errand.nodes[i + 1]].position};
    const double away_m = distance_m(piece, block);
    if (away_m >= nearest_m) continue;
    nearest_m = away_m;
    leg = {state.errand.nodes[i], state.errand.nodes[i + 1]};
  }
  return leg;
}

/// The running order's next stop; what was on the way to another one is forgotten. Whether there is any.
bool take_order(CycleState& state, const std::optional<Order>& order) {
  if (!order || order->state != OrderState::Running || order->stops.empty()) {
    if (state.errand.target) forget_errand(state);
    return false;
  }
  const Target target{order->id, order->round, order->next_stop};
  if (state.errand.target == target) return true;
  auto legs = std::move(state.errand.blocked_legs);
  forget_errand(state);
  state.errand.blocked_legs = std::move(legs);
  state.errand.target = target;
  state.errand.stop = order->stops[target.stop];
  return true;
}

/// The way around that was asked for, or why there is none. An older question's answer is not waited for any
/// more.
void take_answer(CycleState& state, const planning::DetourAnswer& answer, const CycleConfig& config) {
  if (answer.id != state.detour.id || !state.detour.pending) return;
  state.detour.pending = false;
  state.detour.failed = answer.path ? "" : answer.reason;
  if (!answer.path) return;
  const std::size_t rejoin = std::min(answer.rejoin, answer.path->points.size() - 1);
  take_path(state, ending_as_asked(*answer.path, state), config);
  state.way.rejoin_m = state.way.path.along_m(rejoin);
}

}  // namespace

void take_path(CycleState& state, Path path, const CycleConfig& config) {
  state.way = {control::TrackedPath(path, config.pursuit.speed), std::move(path), std::nullopt, false};
  state.progress = {};
  state.ahead = {};
  state.detour.pending = false;
  state.errand.no_way = {};
}

void try_another_route(CycleState& state, const CycleInput& input, const CycleConfig& config,
                       CycleOutput& output) {
  state.block.since = input.now;  // the next try is as far away
  const auto leg = blocked_leg(state, place_of_block(state));
  const auto& routes = state.site->routes();
  const auto goal = routes.index_of(state.errand.stop.node);
  if (!leg || !goal) return;
  auto blocked = blocked_now(state.errand, input.now, config.forget_block_s);
  blocked.insert(*leg);
  const auto other =
      best_route(*state.site, config.metric, state.pose.map_from_base.translation(), *goal, blocked);
  if (!other || is_too_tight(*other, config.tight_corners)) return;
  std::erase_if(state.errand.blocked_legs, [&](const auto& old) {
    return !(to_seconds(input.now - old.second) < config.forget_block_s);
  });
  state.errand.blocked_legs.emplace_back(*leg, input.now);
  output.events.push_back("the leg from node " + std::to_string(routes.nodes()[leg->first].id) + " to node " +
                          std::to_string(routes.nodes()[leg->second].id) +
                          " is blocked: taking another route");
  state.errand.back_outs = 0;  // the other route may need room that this one did not
  plan(state, input, config, output);
}

bool is_beside_stop(const CycleState& state) {
  constexpr double kAtStopM = 0.25;  ///< who loads there finds it; nearer, driving anew would help less
  return !state.way.path.empty() && distance_m(state.pose.map_from_base.translation(),
                                               state.way.path.points().back().position) > kAtStopM;
}

void arrive(CycleState& state, Stamp now) {
  if (state.way.backing) return end_back_out(state);
  state.errand.arrived = true;
  state.errand.dwell_until = now + duration_from_seconds(state.errand.stop.wait_s);
}

planning::BlockedLegs blocked_now(const Errand& errand, Stamp now, double forget_s) {
  planning::BlockedLegs blocked;
  for (const auto& [leg, since] : errand.blocked_legs)
    if (to_seconds(now - since) < forget_s) blocked.insert(leg);
  return blocked;
}

std::optional<Notice> taken_stop(const CycleState& state, const CycleConfig& config) {
  constexpr double kBeforeFrontM = 0.5;  ///< with the room that it keeps, it stands at the stop
  const auto& routes = state.site->routes();
  const auto stop = routes.index_of(state.errand.stop.node);
  const bool seen = state.ahead.check.blocked() && !state.block.unseen && !state.block.by_mover;
  const bool blocked = seen && !state.detour.failed.empty();
  if (state.mode != Mode::Waiting || !blocked || state.errand.arrived || state.way.backing || !stop)
    return {};
  if (!is_placed(state) || waits_for_door(state, config)) return {};
  const double away_m = distance_m(state.pose.map_from_base.translation(), routes.nodes()[*stop].position);
  if (!(away_m < config.check.vehicle.front_m + kBeforeFrontM)) return {};
  const auto node = std::to_string(state.errand.stop.node);
  return notice(Cause::StopTaken, {{"node", node}, {"metres", fmt::format("{:.1f}", away_m)}});
}

/// Whether the pose has come to lie elsewhere: it was corrected, or the vehicle was carried off.
bool has_left_stop(const CycleState& state) {
  return state.errand.arrived && !state.errand.reported && is_beside_stop(state);
}

void navigate(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output) {
  if (!take_order(state, input.order)) return;
  const bool sure = is_placed(state);
  const bool off_path = state.progress.status == control::PursuitStatus::OffPath;
  const bool needs_path = state.way.path.empty() && state.errand.no_way.empty();
  const bool on_way = !state.errand.arrived && (needs_path || off_path);
  if (sure && (on_way || has_left_stop(state))) plan(state, input, config, output);
  if (input.detour) take_answer(state, *input.detour, config);
  const bool told = std::any_of(input.commands.begin(), input.commands.end(),
                                [](const auto& c) { return c.word == OperatorWord::GoOn; });
  if (const auto taken = told && stands(state) ? taken_stop(state, config) : std::nullopt) {
    arrive(state, input.now);
    output.events.push_back(taken->text + "; told to end the stop");
  }
  const bool is_over = input.now >= state.errand.dwell_until && is_place_certain(state.pose.health);
  if (state.errand.arrived && !state.errand.reported && stands(state) && (is_over || told)) {
    state.errand.reported = true;
    output.stop_done = state.errand.target;
  }
}

}  // namespace madori::app
