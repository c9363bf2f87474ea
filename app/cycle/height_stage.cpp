#include <algorithm>
#include <limits>

#include "app/cycle/stages.hpp"

namespace madori::app {
namespace {

constexpr double kBeforeDoorM = 0.8;  ///< from the vehicle's front to the node
constexpr double kLeftZones = 3.0;    ///< door zones away from a node the operator's word for it ends
constexpr double kOnPathM = 1.0;      ///< a path that passes a node farther away does not lead through it

bool is_door(const planning::RouteNode& node) {
  return node.action == planning::NodeAction::Door || node.action == planning::NodeAction::Lift;
}

bool contains(const std::vector<std::size_t>& nodes, std::size_t node) {
  return std::ranges::find(nodes, node) != nodes.end();
}

/// Along the path to where it passes a place; nothing where it does not, or has done so.
std::optional<double> along_of(const CycleState& state, const Point2<Map>& place) {
  std::optional<double> along;
  double nearest_m = kOnPathM;
  for (std::size_t i = 0; i < state.way.plain.points.size(); ++i) {
    const double away_m = distance_m(state.way.plain.points[i].position, place);
    if (away_m >= nearest_m || state.way.path.along_m(i) < state.progress.along_m) continue;
    nearest_m = away_m;
    along = state.way.path.along_m(i);
  }
  return along;
}

/// The first door or lift ahead for which nobody has given the word, by its place in state.errand.nodes.
std::optional<std::size_t> next_door(const CycleState& state, double& along_m) {
  const auto& nodes = state.site->routes().nodes();
  std::optional<std::size_t> first;
  along_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < state.errand.nodes.size(); ++i) {
    const auto& node = nodes[state.errand.nodes[i]];
    if (!is_door(node) || contains(state.block.doors_allowed, state.errand.nodes[i])) continue;
    const auto along = along_of(state, node.position);
    if (!along || *along >= along_m) continue;
    along_m = *along;
    first = i;
  }
  return first;
}

/// The word is given for the door at hand: all of its nodes that follow one another on the route.
void allow(CycleState& state, std::size_t door) {
  const auto& nodes = state.site->routes().nodes();
  for (std::size_t i = door; i < state.errand.nodes.size() && is_door(nodes[state.errand.nodes[i]]); ++i)
    state.block.doors_allowed.push_back(state.errand.nodes[i]);
}

}  // namespace

bool sees_heights(const CycleConfig& config) {
  return config.lidars.empty() || std::ranges::any_of(config.lidars, [](const LidarModel& lidar) {
           return lidar.kind == LidarKind::Spinning;
         });
}

void stop_before_doors(CycleState& state, const CycleConfig& config) {
  state.block.height_unseen = false;
  if (sees_heights(config) || state.way.backing) return;
  const auto& nodes = state.site->routes().nodes();
  const Point2<Map> here = state.pose.map_from_base.translation();
  std::erase_if(state.block.doors_allowed, [&](std::size_t node) {
    return distance_m(nodes[node].position, here) > kLeftZones * config.door_zone_m;
  });
  double along_m = 0.0;
  const auto door = next_door(state, along_m);
  if (!door) return;
  const double stop_m = along_m - config.check.vehicle.front_m - kBeforeDoorM;
  if (stop_m > state.ahead.stop_along_m) return;
  state.ahead.stop_along_m = stop_m;
  state.block.height_unseen = stop_m - state.progress.along_m < config.door_zone_m;
}

void allow_door(CycleState& state) {
  double along_m = 0.0;
  if (!state.block.height_unseen || state.errand.arrived || state.mode != Mode::Waiting) return;
  if (const auto door = next_door(state, along_m)) allow(state, *door);
}

}  // namespace madori::app
