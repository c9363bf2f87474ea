#include "tests/bench/movers/roaming_traffic.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace madori::bench {

using namespace simulation;
using simulation::Building;

namespace {

/// How many of a kind are about, half of their width with room, how fast and how polite they are.
struct Habit {
  MoverKind kind;
  const char* name;
  std::ptrdiff_t count;
  double half_width_m;
  double slowest_mps, fastest_mps;
  double polite_m;
};
constexpr std::array kHabits{Habit{MoverKind::Person, "person ", 4, 0.3, 0.5, 1.8, 0.5},
                             Habit{MoverKind::Cart, "tugger ", 1, 0.5, 0.4, 1.2, 0.8},
                             Habit{MoverKind::Forklift, "lift truck ", 1, 0.75, 0.6, 2.2, 1.2}};

constexpr double kUnseenM = 9.0;                     ///< beyond the reach of the obstacle check
constexpr double kTooFarM = 18.0;                    ///< from the vehicle: of no interest any more
constexpr double kLongS = 60.0;                      ///< then somebody else may come
constexpr double kNearestM = 1.0, kFurthestM = 6.0;  ///< from the vehicle a way passes it
constexpr double kStepM = 0.25;

}  // namespace

double RoamingTraffic::away_m(const Point2<Building>& at) const {
  return distance_m(at, factory_.truth().building_from_base.translation());
}

bool RoamingTraffic::is_free(const Point2<Building>& at, double half_width_m) const {
  const auto outline = rectangle(at, 0.0, 2.0 * half_width_m, 2.0 * half_width_m);
  return factory_.world().obstacles().find(outline, {0.05, 2.1}) == nullptr;
}

bool RoamingTraffic::is_in_sight(const Point2<Building>& at) const {
  constexpr double kHeightM = 1.0;
  const auto here = factory_.truth().building_from_base.translation();
  const double way_m = std::max(distance_m(here, at), 1e-6);
  RayPacket rays;
  rays.x_m.fill(static_cast<float>(here.x_m)), rays.y_m.fill(static_cast<float>(here.y_m));
  rays.z_m.fill(static_cast<float>(kHeightM));
  rays.dx.fill(static_cast<float>((at.x_m - here.x_m) / way_m));
  rays.dy.fill(static_cast<float>((at.y_m - here.y_m) / way_m));
  std::array<Hit, RayPacket::kLanes> hits;
  factory_.world().rays().cast(rays, hits);
  return static_cast<double>(hits.front().range_m) > way_m;
}

std::optional<RoamingTraffic::Way> RoamingTraffic::way_near(const Point2<Building>& here,
                                                            double half_width_m) {
  constexpr double kBeforeM = 12.0, kAfterM = 8.0, kShortestM = 5.0;
  const double aside_m = chance_.uniform(kNearestM, kFurthestM), where = chance_.uniform(-kPi, kPi);
  const double heading = chance_.uniform(-kPi, kPi);
  const Point2<Building> middle{here.x_m + aside_m * std::cos(where), here.y_m + aside_m * std::sin(where)};
  const auto along = [&](double way_m) {
    return Point2<Building>{middle.x_m + way_m * std::cos(heading), middle.y_m + way_m * std::sin(heading)};
  };
  if (!is_free(middle, half_width_m)) return std::nullopt;
  double before_m = 0.0, after_m = 0.0;
  while (before_m < kBeforeM && is_free(along(-before_m - kStepM), half_width_m)) before_m += kStepM;
  while (after_m < kAfterM && is_free(along(after_m + kStepM), half_width_m)) after_m += kStepM;
  const Way way{along(-before_m), along(after_m)};
  if (before_m + after_m < kShortestM || (away_m(way.from) < kUnseenM && is_in_sight(way.from)))
    return std::nullopt;
  return way;
}

void RoamingTraffic::send(MoverKind kind) {
  constexpr int kAttempts = 30;
  const auto& habit =
      *std::find_if(kHabits.begin(), kHabits.end(), [&](const Habit& h) { return h.kind == kind; });
  const auto here = factory_.truth().building_from_base.translation();
  std::optional<Way> way;
  for (int i = 0; i < kAttempts && !way; ++i) way = way_near(here, habit.half_width_m);
  if (!way) return;
  const auto& frames = factory_.world().frames();
  MoverSpec spec;
  spec.kind = kind;
  spec.name = habit.name + std::to_string(++number_);
  spec.path = {frames.plan(way->from), frames.plan(way->to)};
  spec.speed_mps = chance_.uniform(habit.slowest_mps, habit.fastest_mps);
  spec.pause_s = chance_.uniform(1.0, 4.0);
  spec.polite_m = habit.polite_m;
  spec.patience_s = chance_.uniform(2.0, 5.0);
  factory_.add_mover(spec);
  all_.push_back({spec.name, kind, factory_.now()});
}

const Body* RoamingTraffic::body_of(const Somebody& one) const {
  const auto& bodies = factory_.bodies();
  const auto at =
      std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.name == one.name; });
  return at == bodies.end() ? nullptr : &*at;
}

void RoamingTraffic::let_go() {
  std::erase_if(all_, [&](const Somebody& one) {
    const Body* body = body_of(one);
    if (body == nullptr) return false;
    const bool long_about = to_seconds(factory_.now() - one.since) > kLongS;
    const bool unseen = away_m(body->centre) > kUnseenM || !is_in_sight(body->centre);
    if (away_m(body->centre) < kTooFarM && !(long_about && unseen)) return false;
    factory_.remove_mover(one.name);
    return true;
  });
}

void RoamingTraffic::make_room() {
  constexpr double kRoomM = 4.0;
  std::erase_if(all_, [&](const Somebody& one) {
    const Body* body = body_of(one);
    if (body == nullptr || away_m(body->centre) > kRoomM) return false;
    factory_.remove_mover(one.name);
    return true;
  });
}

void RoamingTraffic::advance() {
  let_go();
  for (const Habit& habit : kHabits)
    if (std::count_if(all_.begin(), all_.end(), [&](const auto& one) { return one.kind == habit.kind; }) <
        habit.count)
      send(habit.kind);
}

}  // namespace madori::bench
