#include "tests/end_to_end/soak/witness.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/segment_distance.hpp"

namespace madori::soak {
namespace {

using simulation::Building;

constexpr double kStepS = 0.02;
constexpr double kSurelyWrongM = 0.5;
constexpr double kFoundM = 0.3;
constexpr double kGraceS = 3.0;  ///< in which a carried vehicle may still believe in its old place
constexpr double kNearMissM = 0.1;

/// How far the point lies from the path, near the place where the cycle believes to be.
double distance_from_path(const app::CycleState& state, const Point2<Map>& at) {
  const auto& points = state.way.path.points();
  double best = 1e9;
  const std::size_t from = state.progress.pursuit.index > 30 ? state.progress.pursuit.index - 30 : 0;
  for (std::size_t i = from; i + 1 < points.size() && i < state.progress.pursuit.index + 30; ++i)
    best = std::min(best, distance_m(Segment2<Map>{points[i].position, points[i + 1].position}, at));
  return best;
}

double distance_between(const std::vector<Point2<Building>>& a, const std::vector<Point2<Building>>& b) {
  double best = 1e9;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k)
      best = std::min(best, distance_m(Segment2<Building>{a[i], a[(i + 1) % a.size()]},
                                       Segment2<Building>{b[k], b[(k + 1) % b.size()]}));
  return best;
}

}  // namespace

double clearance_m(const simulation::Factory& factory) {
  const auto& pose = factory.truth().building_from_base;
  double best = 1e9;
  std::vector<Point2<Building>> floor;
  for (const auto& body : factory.bodies()) {
    if (distance_m(body.centre, pose.translation()) > 3.0) continue;
    if (body.z.low_m > factory.vehicle().body().high_m) continue;
    if (floor.empty()) floor = factory.vehicle().footprint(pose);
    best = std::min(best, distance_between(floor, simulation::outline(body)));
  }
  return best;
}

double Witness::time_s() const {
  constexpr double kEpochS = 1'767'225'600.0;  // of the first day
  return to_seconds(factory_.now().time_since_epoch()) - kEpochS;
}

void Witness::kidnapped() {
  kidnapped_at_ = last_kidnapping_ = factory_.now();
  ++figures_.kidnapped;
}

void Witness::compare_pose(const app::CycleState& state) {
  if (state.pose.health.state != LocalizationState::Localized) return;
  const auto truth = factory_.truth().map_from_base;
  const double error_m = distance_m(truth.translation(), state.pose.map_from_base.translation());
  if (kidnapped_at_ && error_m < kFoundM) {
    figures_.found_after_s.push_back(to_seconds(factory_.now() - *kidnapped_at_));
    kidnapped_at_.reset();
  }
  if (last_kidnapping_ && to_seconds(factory_.now() - *last_kidnapping_) < kGraceS) return;
  figures_.pose_error.add(error_m);
  if (error_m > kSurelyWrongM) figures_.sure_but_wrong_s += kStepS;
  if (state.mode == app::Mode::Driving && !state.way.path.empty() && !state.errand.arrived)
    figures_.off_route.add(distance_from_path(state, truth.translation()));
}

void Witness::count_events(const app::CycleOutput& output) {
  for (const auto& event : output.events) {
    if (event.find("-> detouring") != std::string::npos) ++figures_.detours;
    if (event.find("taking another route") != std::string::npos) ++figures_.other_routes;
    if (!verbose_) continue;
    const auto truth = factory_.truth().map_from_base;
    std::printf("%10.2f  %s  (%.2f, %.2f)\n", time_s(), event.c_str(), truth.x_m(), truth.y_m());
  }
}

void Witness::look_for_contact() {
  for (; collisions_ < factory_.collisions().size(); ++collisions_) {
    const auto& c = factory_.collisions()[collisions_];
    const bool moving = c.speed_mps >= 0.01 || c.turn_radps >= 0.01;
    char text[160];
    std::snprintf(text, sizeof text, "day %d, %.1f s: %s at %.2f m/s and %.2f rad/s, (%.2f, %.2f)",
                  figures_.day, time_s(), c.what.c_str(), c.speed_mps, c.turn_radps, c.map_from_base.x_m(),
                  c.map_from_base.y_m());
    (moving ? figures_.collisions_moving : figures_.collisions_standing).emplace_back(text);
    std::printf("collision: %s\n", text);
  }
  const bool moves = std::abs(factory_.truth().linear_mps) > 0.05;
  const bool near = moves && clearance_m(factory_) < kNearMissM;
  if (near && !near_) ++figures_.near_misses;
  near_ = near;
}

/// What the cycle holds to be in its way, beside what is truly near.
void Witness::tell_of_standstill(const app::CycleState& state) const {
  const auto truth = factory_.truth();
  std::printf("            stands at (%.2f, %.2f, %.0f deg): %s at (%.2f, %.2f), free %.2f m%s%s%s; near:",
              truth.map_from_base.x_m(), truth.map_from_base.y_m(), to_deg(truth.map_from_base.yaw_rad()),
              !state.ahead.check.blocked() ? "nothing"
              : state.ahead.check.by_wall  ? "wall"
              : state.block.by_mover       ? "mover"
                                           : "body",
              state.ahead.check.where.x_m, state.ahead.check.where.y_m,
              state.ahead.stop_along_m - state.progress.along_m, state.block.unseen ? ", unseen" : "",
              state.ahead.turn_free ? "" : ", no room to turn",
              state.detour.pending ? ", detour pending" : "");
  const auto map_from_building = truth.map_from_base * truth.building_from_base.inverse();
  for (const auto& body : factory_.bodies()) {
    if (distance_m(body.centre, truth.building_from_base.translation()) > 2.5) continue;
    const auto at = map_from_building * body.centre;
    std::printf(" %s (%.2f, %.2f)", body.name.c_str(), at.x_m, at.y_m);
  }
  std::printf("\n");
}

/// One revolution: where the vehicle is, what it does, what it knows around itself (Base frame) and what is
/// there.
void Witness::trace(const app::CycleOutput& output, const app::CycleState& state) const {
  constexpr double kNearM = 1.6;
  const auto truth = factory_.truth();
  const auto at = truth.map_from_base;
  std::printf(
      "%10.2f  %s (%.3f, %.3f, %.1f deg) %.2f m/s %.2f rad/s, asked %.2f %.2f; free %.2f, share %.1f%s%s",
      time_s(), to_string(state.mode), at.x_m(), at.y_m(), to_deg(at.yaw_rad()), truth.linear_mps,
      truth.angular_radps, output.command.linear_mps, output.command.angular_radps,
      state.ahead.stop_along_m - state.progress.along_m, state.block.squeeze.share,
      state.block.by_mover ? ", mover" : "", state.ahead.turn_free ? "" : ", no room to turn");
  const auto base_from_map = at.inverse();
  const auto base_from_odom = state.odometry.reading().odom_from_base.inverse();
  if (state.ahead.check.blocked()) {
    const auto where = base_from_map * state.ahead.check.where;
    std::printf("; blocked at (%.2f, %.2f)%s%s", where.x_m, where.y_m, state.block.unseen ? ", unseen" : "",
                state.block.felt ? ", felt" : "");
  }
  for (const auto& watch : state.movers) {
    for (const auto& w : watch.out_of_sight.walkers()) {
      const auto last = base_from_odom * w.last.at;
      std::printf("; out of sight: %.1f m high since %.1f s from (%.1f, %.1f) at %.2f m/s", w.high_m,
                  to_seconds(factory_.now() - w.seen), last.x_m, last.y_m,
                  std::hypot(w.last.vx_mps, w.last.vy_mps));
    }
    for (const auto& t : watch.objects.tracks()) {
      const auto last = base_from_odom * t.sightings.back().at;
      std::printf("; track (%.1f, %.1f) %.1f m high, %.1f s", last.x_m, last.y_m, t.high_m,
                  to_seconds(factory_.now() - t.since));
    }
  }
  std::printf("\n            path:");
  for (std::size_t i = state.progress.pursuit.index;
       i < state.way.plain.points.size() && i < state.progress.pursuit.index + 20; i += 3) {
    const auto p = base_from_map * state.way.plain.points[i].position;
    std::printf(" (%.2f, %.2f)", p.x_m, p.y_m);
  }
  std::printf("\n            columns:");
  for (const auto& c : state.obstacles.columns()) {
    const auto p = base_from_odom * c.centre();
    if (std::hypot(p.x_m - 0.3, p.y_m) < kNearM)
      std::printf(" (%.2f, %.2f: %.2f-%.2f, %.1f s%s%s%s%s)", p.x_m, p.y_m, static_cast<double>(c.low_m),
                  static_cast<double>(c.high_m), to_seconds(factory_.now() - c.seen), c.came ? " came" : "",
                  c.part_of_tall ? " tall" : "", c.under != Stamp{} ? " under" : "",
                  !c.confirmed          ? " unsure"
                  : c.has_hidden_part() ? " and on"
                                        : "");
  }
  std::printf("\n            there:");
  for (const auto& body : factory_.bodies()) {
    if (distance_m(body.centre, truth.building_from_base.translation()) > 2.5) continue;
    std::printf(" %s", body.name.c_str());
    for (const auto& corner : simulation::outline(body)) {
      const auto p = truth.building_from_base.inverse() * corner;
      std::printf(" (%.2f, %.2f)", p.x_m, p.y_m);
    }
  }
  std::printf("\n");
}

void Witness::observe(const app::CycleInput& /*input*/, const app::CycleOutput& output,
                      const app::CycleState& state) {
  compare_pose(state);
  count_events(output);
  look_for_contact();
  if (output.computed_lidar && time_s() >= trace_s_.first && time_s() < trace_s_.second) trace(output, state);
  constexpr int kEvery = 250;
  stood_ = state.mode == app::Mode::Waiting ? stood_ + 1 : 0;
  if (verbose_ && stood_ > 0 && stood_ % kEvery == 0) tell_of_standstill(state);
  if (!app::drives(state.mode)) figures_.standstill_s[state.standstill.cause.text] += kStepS;
}

}  // namespace madori::soak
