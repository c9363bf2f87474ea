#include "app/braking/braking_test.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/cycle/stages.hpp"
#include "core/angle.hpp"
#include "core/fill_in.hpp"

namespace madori::app {
namespace {

constexpr double kEvenS = 0.5;   ///< at the speed before the word to stop
constexpr double kStillS = 0.4;  ///< standing counts after so long
constexpr double kReturnMps = 0.2;
constexpr double kKeptFreeM = 0.3;  ///< before what stands at the end of the way

constexpr std::array kTroubles{
    CatalogueEntry{"", ""},
    CatalogueEntry{"no-lidar", "no lidar looks ahead: the vehicle would drive blindly"},
    CatalogueEntry{"no-room", "the test needs {needs} m straight ahead, and {free} m are free"},
    CatalogueEntry{"something-came", "something is in the way"},
    CatalogueEntry{"ended", "the test was ended"},
    CatalogueEntry{"never-fast", "the vehicle did not reach {speed} m/s"},
    CatalogueEntry{"not-understood", "what the wheels did was no stop"},
};

/// What is left in front of a vehicle of this speed when it stands, the brakes taken for half as good.
double stopping_way_m(double speed_mps, const CycleConfig& config) {
  const auto& braking = config.check.braking;
  return speed_mps * braking.before_braking_s() + speed_mps * speed_mps / braking.deceleration_mps2;
}

}  // namespace

const CatalogueEntry& entry(BrakingTrouble trouble) {
  return kTroubles[static_cast<std::size_t>(trouble)];
}

double braking_test_way_m(double speed_mps, const CycleConfig& config) {
  const auto& limits = config.limits;
  const double gaining_s = speed_mps / limits.acceleration_mps2 + limits.acceleration_mps2 / limits.jerk_mps3;
  const double even_s = kEvenS + 2.0 * config.check.braking.reaction_s;  // it follows so much later
  return speed_mps * (gaining_s / 2.0 + even_s) + stopping_way_m(speed_mps, config) + kKeptFreeM;
}

double free_straight_m(const CycleState& state, const CycleConfig& config, bool ahead) {
  const auto base_from_odom = state.odometry.reading().odom_from_base.inverse();
  const planning::VehicleOutline& v = config.check.vehicle;
  const double half_m = v.half_width_m + config.check.sides_margin_m;
  double free_m = planning::PathCheck::kFree;
  for (const planning::Column& c : state.obstacles.columns()) {
    if (!c.confirmed) continue;
    const Point2<Base> at = base_from_odom * c.centre();
    const double away_m = ahead ? at.x_m - v.front_m : -at.x_m - v.rear_m;
    if (std::abs(at.y_m) < half_m + config.field.cell_m && away_m > -config.field.cell_m)
      free_m = std::min(free_m, std::max(0.0, away_m));
  }
  return free_m;
}

void BrakingTest::record(const CycleState& state) {
  if (track_.empty()) {  // what was driven before is no part of this way
    last_ = state.track.back().odom_from_base;
    track_.push_back({state.track.back().stamp, 0.0});
  }
  for (const OdometryReading& reading : state.track) {
    if (reading.stamp <= track_.back().stamp) continue;
    track_.push_back({reading.stamp, track_.back().way_m + (last_.inverse() * reading.odom_from_base).x_m()});
    last_ = reading.odom_from_base;
  }
}

OperatorCommand BrakingTest::straight(double speed_mps, const CycleState& state) const {
  constexpr double kPerS = 0.5, kMostRadps = 0.1;
  const double off_rad = wrap_angle(begun_yaw_rad_ - state.odometry.reading().odom_from_base.yaw_rad());
  const double turn = std::clamp(kPerS * off_rad, -kMostRadps, kMostRadps);
  return {OperatorWord::Jog, {speed_mps, speed_mps == 0.0 ? 0.0 : turn}, {}};
}

BrakingTest::Words BrakingTest::fail(BrakingTrouble why, std::map<std::string, std::string> values) {
  trouble_ = notice(entry(why), std::move(values));
  phase_ = Phase::Ended;
  return {{OperatorWord::Jog, {}, {}}, {OperatorWord::ManualOff, {}, {}}};
}

BrakingTest::Words BrakingTest::begin(const CycleInput& input, const CycleState& state,
                                      const CycleConfig& config) {
  if (is_to_be_confirmed(state.mode)) return fail(BrakingTrouble::Ended);
  if (is_silent(state.lidar_heard, input.now, config.lidar_silent_s)) return fail(BrakingTrouble::NoLidar);
  // It must not wait for what holds it now, a drive that is switched off: nobody would expect it then.
  if (forbidding_rule(state, input, config)) return fail(BrakingTrouble::Ended);
  const double needs_m = braking_test_way_m(plan_.speed_mps, config);
  const double looked_at_m = config.field.reach_m - config.check.vehicle.front_m;
  const double free_m = std::min(free_straight_m(state, config, true), looked_at_m);
  if (free_m < needs_m)
    return fail(BrakingTrouble::NoRoom, {{"needs", two_decimals(needs_m)}, {"free", two_decimals(free_m)}});
  if (state.mode != Mode::Manual) return {{OperatorWord::ManualOn, {}, {}}};
  track_.clear();
  record(state);
  begun_ = input.now;
  begun_yaw_rad_ = last_.yaw_rad();
  even_since_.reset();
  told_.reset();
  phase_ = Phase::Drives;
  return {straight(plan_.speed_mps, state)};
}

BrakingTest::Words BrakingTest::drive(const CycleState& state, const CycleConfig& config) {
  const double now_mps = state.odometry.linear_mps();
  const Stamp now = track_.back().stamp;
  if (free_straight_m(state, config, true) < stopping_way_m(now_mps, config))
    return fail(BrakingTrouble::SomethingCame);
  constexpr double kReached = 0.97;
  if (!even_since_ && now_mps > kReached * plan_.speed_mps) even_since_ = now;
  const double gaining_s = plan_.speed_mps / config.limits.acceleration_mps2;
  constexpr double kPatience = 2.0, kMoreS = 2.0;
  if (!even_since_ && to_seconds(now - begun_) > kPatience * gaining_s + kMoreS)
    return fail(BrakingTrouble::NeverFast, {{"speed", two_decimals(plan_.speed_mps)}});
  if (!even_since_ || to_seconds(now - *even_since_) < kEvenS) return {straight(plan_.speed_mps, state)};
  phase_ = Phase::Brakes;
  return {straight(0.0, state)};
}

/// A record that promises more than the brakes hold makes the cycle take the wheels for faulty: that is what
/// is measured here, and the test goes on.
BrakingTest::Words BrakingTest::go_on() {
  return {{OperatorWord::Confirm, {}, {}}, {OperatorWord::ManualOn, {}, {}}};
}

BrakingTest::Words BrakingTest::brake(const CycleInput& input, const CycleState& state) {
  if (!told_ && state.limits.previous == VelocityCommand{}) told_ = input.now;
  if (!told_ || to_seconds(track_.back().stamp - *told_) < kStillS || !control::has_stopped(track_, kStillS))
    return {straight(0.0, state)};
  const auto stop = control::measure_stop(track_, *told_);
  if (!stop) return fail(BrakingTrouble::NotUnderstood);
  stops_.push_back(*stop);
  phase_ = Phase::Returns;
  return state.mode == Mode::Fault ? go_on() : Words{straight(0.0, state)};
}

BrakingTest::Words BrakingTest::go_back(const CycleState& state, const CycleConfig& config) {
  constexpr double kThereM = 0.05;
  if (track_.back().way_m > kThereM) {
    const double now_mps = std::abs(state.odometry.linear_mps());
    if (free_straight_m(state, config, false) < stopping_way_m(now_mps, config))
      return fail(BrakingTrouble::SomethingCame);
    return {straight(-std::min(kReturnMps, plan_.speed_mps), state)};
  }
  if (!control::has_stopped(track_, kStillS)) return {straight(0.0, state)};
  if (static_cast<int>(stops_.size()) < plan_.stops) {
    phase_ = Phase::Begins;
    return {straight(0.0, state)};
  }
  phase_ = Phase::Ended;
  return {{OperatorWord::ManualOff, {}, {}}};
}

BrakingTest::Words BrakingTest::after_step(const CycleInput& input, const CycleState& state,
                                           const CycleConfig& config) {
  if (phase_ == Phase::Ended) return {};
  const auto stops = [](const OperatorCommand& c) { return event_of(c.word) == ModeEvent::Pause; };
  if (std::ranges::any_of(input.commands, stops)) return fail(BrakingTrouble::Ended);
  if (phase_ == Phase::Begins) return begin(input, state, config);
  record(state);
  const bool brakes_badly = phase_ != Phase::Drives && state.mode == Mode::Fault && state.disobedient &&
                            state.drive.faults == control::wire::kNoFault;
  if (phase_ == Phase::Brakes && (state.mode == Mode::Manual || brakes_badly)) return brake(input, state);
  if (brakes_badly) return control::has_stopped(track_, kStillS) ? go_on() : Words{};
  // Nobody holds a key, nor looks where it goes: what stops a vehicle that drives by itself stops this one.
  if (is_silent(state.lidar_heard, input.now, config.lidar_silent_s)) return fail(BrakingTrouble::NoLidar);
  if (state.mode != Mode::Manual || forbidding_rule(state, input, config)) return fail(BrakingTrouble::Ended);
  return phase_ == Phase::Drives ? drive(state, config) : go_back(state, config);
}

}  // namespace madori::app
