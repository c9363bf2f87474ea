#include "tests/support/virtual_floor.hpp"

#include <algorithm>
#include <cmath>

#include "control/diff_drive/kinematics.hpp"
#include "core/segment_distance.hpp"
#include "planning/route_graph/route_search.hpp"
#include "planning/waypoints/waypoints.hpp"
#include "sensors/vlp16/encode.hpp"
#include "simulation/sensor_suite.hpp"

namespace madori::test {
namespace {

constexpr double kStep_s = 0.02;
constexpr Duration kTick = std::chrono::milliseconds(2);
constexpr Duration kStatusPeriod = std::chrono::milliseconds(10);
constexpr double kAhead_m = 0.9;
constexpr double kPatience_s = 8.0;

}  // namespace

VirtualFloor::VirtualFloor(const mapping::Walls& walls, const simulation::Scenario& scenario,
                           std::uint64_t seed)
    : lidar_(simulation::default_sensors(record_).front()),
      world_(walls, scenario),
      vehicle_(record_, scenario.vehicle, seed),
      drive_(scenario.vehicle),
      vlp16_(lidar_, scenario.vlp16, seed),
      assembler_([this](sensors::vlp16::Frame& frame) { clouds_.push_back(std::move(frame.cloud)); }) {
  for (const auto& mover : scenario.movers) movers_.emplace_back(mover, world_.frames());
  for (const auto& door : scenario.doors) doors_.emplace_back(door, world_.frames());
  state_.pose = world_.frames().building_pose(scenario.map_from_plan * scenario.start);
  track_.add(now_, state_.pose);
}

void VirtualFloor::set_pose(const Transform2<Map, Base>& map_from_base) {
  state_.pose = world_.frames().building_pose(map_from_base);
  track_.clear();
  track_.add(now_, state_.pose);
}

Transform2<Map, Base> VirtualFloor::truth_at(Stamp stamp) const {
  return world_.frames().map_pose(track_.at(stamp - kEpoch));
}

void VirtualFloor::advance_traffic(double dt_s) {
  const simulation::VehicleCircle circle{
      state_.pose * Point2<Base>{record_.length_m / 2.0 - record_.base_to_rear_m, 0.0},
      std::hypot(record_.length_m, record_.width_m) / 2.0};
  for (auto& mover : movers_) mover.advance(to_seconds(now_), dt_s, circle);
  for (auto& door : doors_) door.advance(to_seconds(now_), dt_s, circle, movers_);
  bodies_.clear();
  for (const auto& mover : movers_) bodies_.push_back(mover.body());
  for (const auto& door : doors_)
    if (auto leaf = door.leaf()) bodies_.push_back(std::move(*leaf));
}

void VirtualFloor::tick(const control::WheelSpeeds& asked, Duration dt) {
  now_ += dt;
  const auto before = state_.pose.translation();
  state_ = vehicle_.advance(state_, asked, to_seconds(dt), {}, ++ticks_);
  driven_m_ += distance_m(before, state_.pose.translation());
  track_.add(now_, state_.pose);
  while (vlp16_.next_complete() <= now_) {
    const Duration due = vlp16_.next_complete();
    const auto bytes = sensors::vlp16::encode(vlp16_.measure({world_, track_, bodies_}));
    (void)assembler_.push(bytes, kEpoch + due);
  }
}

FloorInput VirtualFloor::step(const VelocityCommand& command) {
  const WheelGeometry wheels{record_.wheel_radius_m, record_.wheel_radius_m, record_.half_wheel_separation_m};
  const auto asked = control::wheel_speeds(wheels, command);
  FloorInput input;
  advance_traffic(kStep_s);
  const Duration end = now_ + duration_from_seconds(kStep_s);
  while (now_ < end) {
    tick(asked, kTick);
    if (now_ % kStatusPeriod != Duration(0)) continue;
    drive_.tick(state_, false, {}, now_);
    for (const std::uint8_t byte : drive_.status_frame()) {
      control::wire::Status status;
      if (cutter_.push(byte) &&
          control::wire::decode(cutter_.frame(), cutter_.size(), status) == control::wire::Verdict::Good)
        input.drive.push_back(status);
    }
  }
  input.now = now();
  input.clouds = std::exchange(clouds_, {});
  return input;
}

bool VirtualFloor::is_blocked(double ahead_m, double reach_m) const {
  const auto ahead = state_.pose * Point2<Base>{ahead_m, 0.0};
  return std::any_of(bodies_.begin(), bodies_.end(), [&](const simulation::Body& body) {
    return distance_m(body.centre, ahead) < reach_m + body.reach_m();
  });
}

/// The nearest node; of the nearest leg the end that lies behind, where the way ahead is blocked: a person
/// who waits for the vehicle would wait for ever.
std::size_t TrueDriver::start_node(const Transform2<Map, Base>& from, bool is_blocked) const {
  const auto& nodes = routes_.nodes();
  const auto nearer = [&](const auto& a, const auto& b) {
    return distance_m(a.position, from.translation()) < distance_m(b.position, from.translation());
  };
  if (!is_blocked)
    return static_cast<std::size_t>(std::min_element(nodes.begin(), nodes.end(), nearer) - nodes.begin());
  const auto& legs = routes_.legs();
  const auto off_m = [&](const planning::RouteLeg& leg) {
    return distance_m(Segment2<Map>{nodes[leg.from].position, nodes[leg.to].position}, from.translation());
  };
  const auto leg = *std::min_element(legs.begin(), legs.end(),
                                     [&](const auto& a, const auto& b) { return off_m(a) < off_m(b); });
  const auto ahead_m = [&](std::size_t node) { return (from.inverse() * nodes[node].position).x_m; };
  return ahead_m(leg.from) < ahead_m(leg.to) ? leg.from : leg.to;
}

void TrueDriver::choose(const Transform2<Map, Base>& from, bool is_blocked) {
  const auto& nodes = routes_.nodes();
  const std::size_t start = start_node(from, is_blocked);
  const auto stations = routes_.stations();
  for (int attempt = 0; attempt < 100; ++attempt) {
    const auto route = planning::find_route(routes_, start, stations[random_.below(stations.size())],
                                            planning::RouteMetric::Metres);
    if (!route || route.value().nodes.size() < 2) continue;
    std::vector<planning::WayCorner> way{{from.translation()}};
    for (const std::size_t node : route.value().nodes)
      if (distance_m(nodes[node].position, way.back().position) > 0.3) way.push_back({nodes[node].position});
    auto path = planning::make_waypoints(way, {}, nodes[route.value().nodes.back()].heading_rad);
    if (!path) continue;
    path_ = control::TrackedPath(std::move(path).value(), options_.speed);
    pursuit_ = {};
    return;
  }
}

VelocityCommand TrueDriver::command(const VirtualFloor& floor) {
  const auto truth = floor.truth();
  if (path_.empty()) choose(truth, turns_back_);
  if (path_.empty()) return {};
  const bool blocked = floor.is_blocked(kAhead_m, 0.5);
  waited_s_ = blocked ? waited_s_ + kStep_s : 0.0;
  const auto out = control::pursue(path_, pursuit_, {.map_from_base = truth}, options_);
  pursuit_ = out.state;
  const bool over = out.status == control::PursuitStatus::Arrived ||
                    out.status == control::PursuitStatus::OffPath || waited_s_ > kPatience_s;
  if (over) {
    turns_back_ = waited_s_ > kPatience_s;
    path_ = {};
    waited_s_ = 0.0;
  }
  const bool stands = over || (blocked && out.status == control::PursuitStatus::Following);
  const auto limited = control::limit(
      limits_, {.requested = stands ? VelocityCommand{} : out.command, .may_move = true, .step_s = kStep_s},
      {});
  limits_ = limited.state;
  return limited.command;
}

}  // namespace madori::test
