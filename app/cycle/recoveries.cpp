#include "app/cycle/recoveries.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/cycle/stages.hpp"

namespace madori::app {
namespace {

double left_m(const CycleState& state, double along_m) {
  return along_m - state.progress.along_m;
}

bool is_waiting(const CycleState& state) {
  return state.mode == Mode::Waiting && state.block.since && !state.errand.arrived;
}

double blocked_s(const CycleState& state, Stamp now) {
  return state.block.since ? to_seconds(now - *state.block.since) : 0.0;
}

bool sees_near(const CycleState& state, const CycleInput& /*input*/, const CycleConfig& /*config*/) {
  return state.ahead.care_along_m != planning::PathCheck::kFree || state.block.squeeze.share < 1.0 ||
         state.pose.health.state == LocalizationState::Degraded;
}

/// Slower from afar, so that it is as slow as it shall be when it is beside what is near.
double care_mps(const CycleState& state, const CycleConfig& config) {
  const double care_m = std::max(0.0, left_m(state, state.ahead.care_along_m));
  const double beside = state.block.squeeze.share < 1.0 ? config.narrow_speed_mps : config.care_speed_mps;
  const double care = std::sqrt(beside * beside + 2.0 * config.pursuit.speed.deceleration_mps2 * care_m);
  const bool degraded = state.pose.health.state == LocalizationState::Degraded;
  return degraded ? std::min(care, config.degraded_speed_mps) : care;
}

bool is_ended(const CycleState& state, const CycleInput& /*input*/, const CycleConfig& /*config*/) {
  return state.ahead.stop_along_m != planning::PathCheck::kFree;
}

double stop_mps(const CycleState& state, const CycleConfig& config) {
  return braking_once_obeyed(config).speed_within(left_m(state, state.ahead.stop_along_m));
}

bool may_go_around(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  constexpr double kWithinM = 4.0;  ///< what is further away may be gone when the vehicle gets there
  const bool stuck = !state.ahead.turn_free || state.ahead.held;
  const bool near = stuck || left_m(state, state.ahead.stop_along_m) < kWithinM;
  const bool going = drives(state.mode) || state.mode == Mode::Waiting;
  return (state.ahead.check.blocked() || stuck) && near && going && !state.way.backing &&
         !state.block.by_mover && state.block.since && !state.detour.pending &&
         !waits_for_door(state, config) && blocked_s(state, input.now) >= config.detour_after_s &&
         to_seconds(input.now - state.detour.asked) >= config.detour_again_s;
}

bool is_narrow(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  if (state.way.backing) return false;
  return state.block.squeeze.share < 1.0 ||
         (is_waiting(state) && !state.block.by_mover && blocked_s(state, input.now) > config.squeeze_after_s);
}

bool may_back_out(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  constexpr double kNearM = 0.6;
  constexpr int kMost = 2;  ///< on one route
  const bool near = left_m(state, state.ahead.stop_along_m) < kNearM && !state.detour.failed.empty();
  const bool wedged = state.block.felt || state.ahead.held || !state.ahead.turn_free ||
                      state.block.squeeze.share < 1.0 || near;
  return is_waiting(state) && wedged && is_placed(state) && !state.block.by_mover && !state.detour.pending &&
         !state.way.path.empty() && !waits_for_door(state, config) && state.errand.back_outs < kMost &&
         blocked_s(state, input.now) > config.back_out_after_s &&
         to_seconds(input.now - state.trail_at) < config.trail_fresh_s;
}

bool may_take_another(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  const double patience_s =
      waits_for_door(state, config) ? config.door_reroute_after_s : config.reroute_after_s;
  return is_placed(state) && is_waiting(state) && blocked_s(state, input.now) > patience_s;
}

constexpr std::array kRecoveries{
    Recovery{"slow",
             "something within 0.15 m more than the margins, less than the margins, or a pose in doubt",
             "0.4 m/s beside it (0.2 m/s with less than the margins), slower from afar", "until it is passed",
             sees_near, care_mps, nullptr},
    Recovery{"stop", "something within the margins, a turn that is not free, or who crosses",
             "stands before it, and waits", "until it has been free for 0.6 s", is_ended, stop_mps, nullptr},
    Recovery{"detour", "blocked for 1.5 s within 4 m, by nobody who crosses, not before a door",
             "a way around: beside the route, through the free space, a manoeuvre",
             "every 4 s, one search at a time", may_go_around, nullptr, ask_for_detour},
    Recovery{"less margin", "waits for 10 s, not for somebody who crosses",
             "half of every margin, then a fifth; ways around with as much; what is within them already may "
             "be left",
             "until the next 3 m have one and a half times all of them", is_narrow, nullptr, squeeze},
    Recovery{"back out", "blocked for 12 s, too near to something to go around it",
             "0.8 m back the way it came, else straight", "twice a route, within 60 s of its last move",
             may_back_out, nullptr, back_out},
    Recovery{"another route", "blocked for 25 s, before a door 60 s", "the blocked leg is left out for 180 s",
             "where another route leads there", may_take_another, nullptr, try_another_route},
};

bool always(const CycleState& /*state*/, const CycleConfig& /*config*/) {
  return true;
}

const std::array kAsks{
    Ask{entry(Cause::HeldBack), entry(Remedy::LookAndResume),
        [](const auto& s, const auto&) { return s.block.felt; }},
    Ask{entry(Cause::HeightUnseen), entry(Remedy::LookAndGoOn),
        [](const auto& s, const auto&) { return s.block.height_unseen; }},
    Ask{entry(Cause::NoRoomToTurn), entry(Remedy::ClearAround),
        [](const auto& s, const auto&) { return !s.ahead.turn_free; }},
    Ask{entry(Cause::DoorNotOpen), entry(Remedy::OnceOpen), waits_for_door},
    Ask{entry(Cause::WallInTheWay), entry(Remedy::MoveRoute),
        [](const auto& s, const auto&) { return s.ahead.check.blocked() && s.ahead.check.by_wall; }},
    Ask{entry(Cause::UnseenInTheWay), entry(Remedy::LookAndResume),
        [](const auto& s, const auto&) { return s.block.unseen; }},
    Ask{entry(Cause::SomethingInTheWay), entry(Remedy::ClearWay),
        [](const auto& s, const auto&) { return !s.detour.failed.empty(); }},
    Ask{entry(Cause::SomethingInTheWay), entry(Remedy::OnceClear), always},
};

}  // namespace

std::span<const Recovery> recoveries() {
  return kRecoveries;
}

void recover(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output) {
  if (!state.errand.target) return;
  for (const Recovery& recovery : kRecoveries)
    if (recovery.act != nullptr && recovery.due(state, input, config))
      recovery.act(state, input, config, output);
}

double allowed_mps(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  double most = std::min(config.check.braking.speed_within(sure_range_m(state, input.now, config)),
                         unseen_bodies_mps(state, input.now, config));
  for (const Recovery& recovery : kRecoveries)
    if (recovery.most_mps != nullptr && recovery.due(state, input, config))
      most = std::min(most, recovery.most_mps(state, config));
  return most;
}

std::span<const Ask> asks() {
  return kAsks;
}

}  // namespace madori::app
