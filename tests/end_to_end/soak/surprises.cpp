#include "tests/end_to_end/soak/surprises.hpp"

#include <algorithm>
#include <cmath>

#include "app/cycle/stages.hpp"
#include "core/segment_distance.hpp"
#include "planning/route_graph/route_search.hpp"

namespace madori::soak {
namespace {

using simulation::MoverKind;
using simulation::Random;

constexpr double kNearestM = 6.0;     ///< ahead of the vehicle
constexpr double kBeforeGoalM = 4.0;  ///< nothing is put nearer to the end of the way
constexpr double kAwayFromDoorM = 5.0;

/// A point of the way ahead, between kNearestM and kBeforeGoalM before its end.
const PathPoint* ahead(const app::CycleState& state, Random& random) {
  const double whole_m =
      state.way.path.empty() ? 0.0 : state.way.path.along_m(state.way.path.points().size() - 1);
  const double first_m = state.progress.along_m + kNearestM;
  const double last_m = std::min(whole_m - kBeforeGoalM, state.progress.along_m + 25.0);
  const double chosen = random.uniform();
  if (last_m <= first_m) return nullptr;
  const double at_m = first_m + chosen * (last_m - first_m);
  for (std::size_t i = 0; i < state.way.path.points().size(); ++i)
    if (state.way.path.along_m(i) >= at_m) return &state.way.path.points()[i];
  return nullptr;
}

Point2<Map> beside(const PathPoint& p, double left_m) {
  return {p.position.x_m - left_m * std::sin(p.heading_rad),
          p.position.y_m + left_m * std::cos(p.heading_rad)};
}

bool near_door(const app::CycleConfig& config, const Point2<Map>& place) {
  return std::any_of(config.routes.nodes().begin(), config.routes.nodes().end(), [&](const auto& node) {
    return planning::is_door(node.action) && distance_m(node.position, place) < kAwayFromDoorM;
  });
}

bool meets_wall(const app::CycleConfig& config, const Segment2<Map>& line) {
  const Point2<Map> middle{(line.a.x_m + line.b.x_m) / 2.0, (line.a.y_m + line.b.y_m) / 2.0};
  return config.walls->any_near(middle, line.length_m() / 2.0 + 0.5,
                                [&](const Segment2<Map>& wall) { return distance_m(wall, line) < 0.4; });
}

}  // namespace

Surprises::Surprises(simulation::Factory& factory, const simulation::Scenario& scenario,
                     const app::CycleConfig& config)
    : factory_(factory), config_(config), plan_from_map_(scenario.map_from_plan.inverse()) {}

void Surprises::add(MoverKind kind, const std::vector<Point2<Map>>& path, double yaw_rad, double speed_mps,
                    bool stays) {
  simulation::MoverSpec spec;
  spec.kind = kind;
  spec.name = (kind == MoverKind::Pallet ? "pallet " : "passer-by ") + std::to_string(++number_);
  for (const auto& p : path) spec.path.push_back(plan_from_map_ * p);
  spec.yaw_deg = to_deg(yaw_rad + plan_from_map_.yaw_rad());
  spec.speed_mps = speed_mps;
  spec.pause_s = 3.0;
  spec.polite_m = 0.5;
  spec.patience_s = 5.0;
  factory_.add_mover(spec);
  things_.push_back({spec.name, path.front(), stays, path.size() > 1});
}

void Surprises::close_aisle(const planning::RouteLeg& leg) {
  const Point2<Map>& a = config_.routes.nodes()[leg.from].position;
  const Point2<Map>& b = config_.routes.nodes()[leg.to].position;
  const double yaw = std::atan2(b.y_m - a.y_m, b.x_m - a.x_m);
  const PathPoint middle{{(a.x_m + b.x_m) / 2.0, (a.y_m + b.y_m) / 2.0}, yaw};
  for (const double left_m : {-1.3, 0.0, 1.3})
    add(MoverKind::Pallet, {beside(middle, left_m)}, yaw + kPi / 2.0, 1.0, true);
}

bool Surprises::put_pallet(const app::CycleState& state, Random& random) {
  const PathPoint* at = ahead(state, random);
  const double left_m = random.uniform(-0.5, 0.5);
  const double yaw = random.uniform(0.0, kPi);
  if (at == nullptr || near_door(config_, at->position)) return false;
  const Point2<Map> place = beside(*at, left_m);
  if (distance_m(place, factory_.truth().map_from_base.translation()) < kNearestM / 2.0) return false;
  add(MoverKind::Pallet, {place}, yaw, 1.0, false);
  return true;
}

bool Surprises::send_person(const app::CycleState& state, Random& random) {
  const PathPoint* at = ahead(state, random);
  const double speed = random.uniform(0.6, 1.6);
  const double side = random.below(2) == 0 ? 1.0 : -1.0;
  if (at == nullptr) return false;
  const Point2<Map> from = beside(*at, 3.0 * side);
  const Point2<Map> to = beside(*at, -3.0 * side);
  if (meets_wall(config_, {from, to})) return false;
  add(MoverKind::Person, {from, to}, 0.0, speed, false);
  return true;
}

bool Surprises::has_room(const Transform2<Map, Base>& pose) const {
  constexpr int kHeadings = 12;
  for (int i = 0; i < kHeadings; ++i)
    if (!factory_.is_free(pose * Transform2<Base, Base>(0.0, 0.0, 2.0 * kPi * i / kHeadings))) return false;
  return true;
}

Transform2<Map, Base> Surprises::carry_away(Random& random, bool to_help) {
  const auto& nodes = config_.routes.nodes();
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const auto& node = nodes[random.below(nodes.size())];
    const Transform2<Map, Base> pose(node.position.x_m + random.uniform(-0.5, 0.5),
                                     node.position.y_m + random.uniform(-0.5, 0.5),
                                     random.uniform(-kPi, kPi));
    const auto moved = [&](double x, double y) { return pose * Transform2<Base, Base>(x, y, 0.0); };
    const bool free = factory_.is_free(moved(0.3, 0.0)) && factory_.is_free(moved(-0.3, 0.0)) &&
                      factory_.is_free(moved(0.0, 0.3)) && factory_.is_free(moved(0.0, -0.3));
    const bool far = distance_m(pose.translation(), factory_.truth().map_from_base.translation()) > 5.0;
    if (!free || !far || (to_help && !has_room(pose))) continue;
    factory_.set_pose(pose);
    return pose;
  }
  return factory_.truth().map_from_base;
}

void Surprises::clear() {
  for (const Thing& thing : things_)
    if (!thing.stays) factory_.remove_mover(thing.name);
  std::erase_if(things_, [](const Thing& thing) { return !thing.stays; });
}

bool Surprises::take_away_near(const Point2<Map>& place) {
  constexpr double kReachM = 2.5;
  const auto near = [&](const Thing& t) { return distance_m(t.place, place) < kReachM; };
  for (const Thing& thing : things_)
    if (near(thing)) factory_.remove_mover(thing.name);
  return std::erase_if(things_, near) > 0;
}

bool Surprises::stands_at(const Point2<Map>& place) const {
  constexpr double kStepM = 0.5;
  const auto truth = factory_.truth();
  const auto at = truth.building_from_base * (truth.map_from_base.inverse() * place);
  const auto outline = simulation::rectangle(at, 0.0, 2.0 * kStepM, 2.0 * kStepM);
  if (factory_.world().obstacles().find(outline, factory_.vehicle().body()) != nullptr) return true;
  return std::any_of(factory_.bodies().begin(), factory_.bodies().end(), [&](const auto& body) {
    return simulation::overlap(outline, simulation::outline(body));
  });
}

bool Surprises::another_way(std::size_t goal) const {
  constexpr double kCoversM = 1.2;  // half the vehicle, half a pallet, margins
  const auto& nodes = config_.routes.nodes();
  const Point2<Map> here = factory_.truth().map_from_base.translation();
  planning::BlockedLegs blocked;
  for (const auto& leg : config_.routes.legs())
    for (const Thing& thing : things_)
      if (!thing.walks &&
          distance_m(Segment2<Map>{nodes[leg.from].position, nodes[leg.to].position}, thing.place) < kCoversM)
        blocked.insert({leg.from, leg.to});
  for (std::size_t first = 0; first < nodes.size(); ++first) {
    // The vehicle stands between this node and what is in its way, or at the node.
    const bool reachable = std::none_of(things_.begin(), things_.end(), [&](const Thing& thing) {
      return !thing.walks && distance_m(Segment2<Map>{here, nodes[first].position}, thing.place) < kCoversM;
    });
    const bool near =
        std::any_of(config_.routes.legs().begin(), config_.routes.legs().end(), [&](const auto& leg) {
          return (leg.from == first || leg.to == first) &&
                 distance_m(Segment2<Map>{nodes[leg.from].position, nodes[leg.to].position}, here) < 1.0;
        });
    if (near && reachable &&
        planning::find_route(config_.routes, first, goal, planning::RouteMetric::Hops, blocked))
      return true;
  }
  return false;
}

}  // namespace madori::soak
