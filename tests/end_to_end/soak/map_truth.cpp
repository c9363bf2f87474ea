#include "tests/end_to_end/soak/map_truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/segment_distance.hpp"
#include "tests/support/outline_distance.hpp"

namespace madori::soak {
namespace {

using localization::CellState;
using localization::CellTree;
using localization::HybridMap;

constexpr double kToleranceM = 0.2;
constexpr double kSightM = 12.0;
constexpr double kHeightM = 0.25;
constexpr double kAroundDoorsM = 0.6;
constexpr int kFewestLooks = 3;

/// What the cells within the tolerance say of a place: the layer where one says so, else what else stands
/// there, else what its own cell says.
CellState shown(const HybridMap& map, const Point2<Map>& p, CellState layer) {
  const CellState other = layer == CellState::Static ? CellState::SemiStatic : CellState::Static;
  CellState found = map.state_at(p);
  for (const double dy : {0.0, -kToleranceM, kToleranceM})
    for (const double dx : {0.0, -kToleranceM, kToleranceM}) {
      const CellState state = map.state_at({p.x_m + dx, p.y_m + dy});
      if (state == layer) return layer;
      if (state == other) found = other;
    }
  return found;
}

constexpr std::array<const char*, 6> kStates{"unseen",      "free",   "moving",
                                             "semi_static", "static", "taken_away"};

nlohmann::json shares(std::size_t right, std::size_t cells, std::size_t found, std::size_t sought) {
  const auto share = [](std::size_t part, std::size_t of) {
    return of == 0 ? nlohmann::json() : nlohmann::json(static_cast<double>(part) / static_cast<double>(of));
  };
  return {{"cells", cells},
          {"precision", share(right, cells)},
          {"places", sought},
          {"recall", share(found, sought)}};
}

}  // namespace

Point2<Map> MapTruth::on_map(const Point2<simulation::Building>& p) const {
  const auto& frames = factory_.world().frames();
  return frames.map_from_plan * frames.plan(p);
}

Point2<simulation::Building> MapTruth::in_building(const Point2<Map>& p) const {
  const auto& frames = factory_.world().frames();
  return frames.building(frames.map_from_plan.inverse() * p);
}

std::vector<MapTruth::Thing> MapTruth::things() const {
  std::vector<Thing> all;
  for (const auto& obstacle : factory_.world().obstacles().all())
    all.push_back({obstacle.outline, obstacle.name == "pallet" || obstacle.name == "clutter"});
  for (const auto& body : factory_.bodies())
    if (body.name.starts_with("pallet ")) all.push_back({simulation::outline(body), true});
  return all;
}

bool MapTruth::near_door(const Point2<simulation::Building>& p) const {
  return std::any_of(factory_.doors().begin(), factory_.doors().end(),
                     [&](const auto& door) { return distance_m(door.line(), p) < kAroundDoorsM; });
}

void MapTruth::look() {
  constexpr double kEveryM = 0.5;
  constexpr int kDirections = 720;
  using Packet = simulation::RayPacket;
  const Point2<simulation::Building> here = factory_.truth().building_from_base.translation();
  if (distance_m(here, looked_) < kEveryM) return;
  looked_ = here;
  std::set<Place> now;
  for (int first = 0; first < kDirections; first += static_cast<int>(Packet::kLanes)) {
    Packet rays;
    for (std::size_t i = 0; i < Packet::kLanes; ++i) {
      const double angle = 2.0 * kPi * (first + static_cast<int>(i)) / kDirections;
      rays.x_m[i] = static_cast<float>(here.x_m), rays.y_m[i] = static_cast<float>(here.y_m);
      rays.z_m[i] = static_cast<float>(kHeightM);
      rays.dx[i] = static_cast<float>(std::cos(angle)), rays.dy[i] = static_cast<float>(std::sin(angle));
    }
    std::array<simulation::Hit, Packet::kLanes> hits;
    factory_.world().rays().cast(rays, hits);
    for (std::size_t i = 0; i < Packet::kLanes; ++i) {
      const double range = hits[i].range_m;
      if (!(range < kSightM)) continue;
      const Point2<simulation::Building> at{here.x_m + range * static_cast<double>(rays.dx[i]),
                                            here.y_m + range * static_cast<double>(rays.dy[i])};
      const Place place{static_cast<int>(std::floor(at.x_m * 10.0)),
                        static_cast<int>(std::floor(at.y_m * 10.0))};
      if (!now.insert(place).second) continue;
      auto& seen = seen_.try_emplace(place, 0, at).first->second;
      ++seen.first;
    }
  }
}

nlohmann::json MapTruth::compare(const HybridMap& map) const {
  const std::vector<Thing> all = things();
  /// Distance to the nearest static and to the nearest semi-static thing.
  const auto distances = [&](const Point2<simulation::Building>& p) {
    std::array<double, 2> nearest{1e9, 1e9};
    for (const Thing& thing : all)
      nearest[thing.semi_static ? 1 : 0] =
          std::min(nearest[thing.semi_static ? 1 : 0], test::distance_to(thing.outline, p));
    return nearest;
  };
  std::array<std::size_t, 2> cells{}, right{}, sought{}, found{};
  std::array<std::array<std::size_t, kStates.size()>, 2> as{};
  std::size_t phantoms = 0, moving = 0, known = 0;
  const CellTree& tree = map.cells();
  for (CellTree::Index i = 0; i < tree.size(); ++i) {
    const CellState state = map.state(i);
    known += state != CellState::Unseen ? 1 : 0;
    moving += state == CellState::Moving ? 1 : 0;
    if (state != CellState::Static && state != CellState::SemiStatic) continue;
    const auto& g = tree[i].gaussian;
    const Point2<simulation::Building> p =
        in_building(g.empty() ? map.centre(tree.place(i)) : Point2<Map>{g.x_m, g.y_m});
    if (near_door(p)) continue;
    const auto nearest = distances(p);
    const std::size_t layer = state == CellState::Static ? 0 : 1;
    ++cells[layer];
    right[layer] += nearest[layer] < kToleranceM ? 1 : 0;
    phantoms += std::min(nearest[0], nearest[1]) >= kToleranceM ? 1 : 0;
  }
  for (const auto& [place, seen] : seen_) {
    if (seen.first < kFewestLooks || near_door(seen.second)) continue;
    const auto nearest = distances(seen.second);
    const std::size_t layer = nearest[0] <= nearest[1] ? 0 : 1;
    ++sought[layer];
    const CellState wanted = layer == 0 ? CellState::Static : CellState::SemiStatic;
    const CellState state = shown(map, on_map(seen.second), wanted);
    found[layer] += state == wanted ? 1 : 0;
    ++as[layer][static_cast<std::size_t>(state)];
  }
  nlohmann::json read_as;
  for (const std::size_t layer : {0U, 1U})
    for (std::size_t i = 0; i < kStates.size(); ++i)
      read_as[layer == 0 ? "static" : "semi_static"][kStates[i]] = as[layer][i];
  return {{"static", shares(right[0], cells[0], found[0], sought[0])},
          {"semi_static", shares(right[1], cells[1], found[1], sought[1])},
          {"read_as", read_as},
          {"phantoms", phantoms},
          {"moving", moving},
          {"known", known},
          {"bytes", tree.bytes()}};
}

}  // namespace madori::soak
