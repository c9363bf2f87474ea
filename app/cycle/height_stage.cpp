#include <algorithm>
#include <limits>

#include "app/cycle/stages.hpp"

namespace madori::app {
namespace {

constexpr double kLeftZones = 3.0;  ///< door zones away from a node the operator's word for it ends

bool contains(const std::vector<std::size_t>& nodes, std::size_t node) {
  return std::ranges::find(nodes, node) != nodes.end();
}

/// Along the path ahead to where a door's zone begins: on which side of its node the door is nobody says.
/// Nothing where the path does not come so near to it any more.
std::optional<double> along_of(const CycleState& state, const Point2<Map>& door, double zone_m) {
  for (std::size_t i = 0; i < state.way.plain.points.size(); ++i) {
    const double along_m = state.way.path.along_m(i);
    if (along_m < state.progress.along_m) continue;
    if (distance_m(state.way.plain.points[i].position, door) < zone_m) return along_m;
  }
  return std::nullopt;
}

/// The first door or lift ahead for which nobody has given the word.
std::optional<std::size_t> next_door(const CycleState& state, const CycleConfig& config, double& along_m) {
  const auto& nodes = state.site->routes().nodes();
  std::optional<std::size_t> first;
  along_m = std::numeric_limits<double>::infinity();
  for (const std::size_t door : state.errand.doors) {
    if (contains(state.block.doors_allowed, door)) continue;
    const auto along = along_of(state, nodes[door].position, config.door_zone_m);
    if (!along || *along >= along_m) continue;
    along_m = *along;
    first = door;
  }
  return first;
}

/// The word is given for the door at hand: all of its nodes that follow one another on the route.
void allow(CycleState& state, std::size_t door) {
  state.block.doors_allowed.push_back(door);
  const auto& nodes = state.errand.nodes;
  for (auto at = std::ranges::find(nodes, door); at != nodes.end() && contains(state.errand.doors, *at); ++at)
    state.block.doors_allowed.push_back(*at);
}

/// A door that was seen shut is open anew: how high, nobody has looked. One that rises is open first where a
/// level lidar looks.
void forget_word_of_shut_door(CycleState& state, const CycleConfig& config) {
  const bool shut = state.mode == Mode::Waiting && waits_for_door(state, config) && !state.block.by_mover;
  if (state.block.door_shut && !shut) state.block.doors_allowed.clear();
  state.block.door_shut = shut;
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
  forget_word_of_shut_door(state, config);
  const auto& nodes = state.site->routes().nodes();
  const Point2<Map> here = state.pose.map_from_base.translation();
  std::erase_if(state.block.doors_allowed, [&](std::size_t node) {
    return distance_m(nodes[node].position, here) > kLeftZones * config.door_zone_m;
  });
  double along_m = 0.0;
  if (!next_door(state, config, along_m)) return;
  const double stop_m = along_m - config.check.vehicle.front_m;
  if (stop_m > state.ahead.stop_along_m) return;
  state.ahead.stop_along_m = stop_m;
  state.block.height_unseen = stop_m - state.progress.along_m < config.door_zone_m;
}

void allow_door(CycleState& state, const CycleConfig& config) {
  double along_m = 0.0;
  if (!state.block.height_unseen || state.errand.arrived || state.mode != Mode::Waiting) return;
  if (const auto door = next_door(state, config, along_m)) allow(state, *door);
}

bool is_at_door(const CycleState& state, const Point2<Map>& place, const CycleConfig& config) {
  const auto& nodes = state.site->routes().nodes();
  return std::ranges::any_of(state.errand.doors, [&](std::size_t door) {
    return distance_m(nodes[door].position, place) < config.door_zone_m;
  });
}

bool waits_for_door(const CycleState& state, const CycleConfig& config) {
  const bool on_route = !state.way.rejoin_m;  // beside it, what stands there is the wall beside the door
  return on_route && state.ahead.check.blocked() && !state.block.unseen &&
         is_at_door(state, state.ahead.check.where, config);
}

}  // namespace madori::app
