#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "app/cycle/drive_faults.hpp"
#include "app/cycle/recoveries.hpp"
#include "app/cycle/stages.hpp"
#include "core/fill_in.hpp"

namespace madori::app {
namespace {

using control::wire::DriveState;

Standstill because(Cause cause, Remedy remedy, Stamp now) {
  return {notice(cause), notice(remedy), now};
}

Standstill why_emergency(const CycleState& state, Stamp now) {
  if (state.drive.bumper || state.drive.state == DriveState::BumperStop)
    return because(Cause::BumperPressed, Remedy::FreeAndConfirm, now);
  if (state.drive.emergency_stop || state.drive.state == DriveState::EmergencyStop)
    return because(Cause::EmergencyStopPressed, Remedy::ReleaseAndConfirm, now);
  return because(Cause::EmergencyStopOver, Remedy::LookAndConfirm, now);
}

Standstill why_fault(const CycleState& state, const CycleInput& input) {
  if (tells_fault(state.drive))
    return {notice(Cause::DriveFault, {{"faults", fault_words(state.drive.faults)}}),
            notice(Remedy::MendDrive), input.now};
  if (state.disobedient) {
    const auto& [left, asked_mps, turned_mps] = *state.disobedient;
    return {notice(left ? Cause::LeftWheelDisobeys : Cause::RightWheelDisobeys,
                   {{"asked", two_decimals(asked_mps)}, {"turned", two_decimals(turned_mps)}}),
            notice(Remedy::LookAtWheel), input.now};
  }
  return because(Cause::FaultOver, Remedy::Confirm, input.now);
}

/// What is silent keeps the vehicle standing whatever its mode: it is said before all that a person could
/// end. After a start or a gap a device has its time to be heard before it is called silent.
Standstill why_deaf(const CycleState& state, Stamp now, const CycleConfig& config) {
  const auto silent = [&](const std::optional<Stamp>& heard, double limit_s) {
    return is_silent(std::max({heard, state.gap, std::optional(state.begun)}), now, limit_s);
  };
  if (silent(state.drive_heard, config.drive_silent_s))
    return because(Cause::DriveSilent, Remedy::CheckDrive, now);
  if (is_drive_deaf(state, now, config)) return because(Cause::DriveDeaf, Remedy::CheckDrive, now);
  if (is_drive_late(state, now, config)) return because(Cause::DriveLate, Remedy::CheckDrive, now);
  if (are_wheels_untold(state, now, config)) return because(Cause::WheelsUntold, Remedy::CheckDrive, now);
  const bool asks_person = is_to_be_confirmed(state.mode);
  if (!asks_person && silent(state.lidar_heard, config.lidar_silent_s)) {
    const std::string names = silent_lidars(state, now, config);
    if (state.lidar_heard && names.empty()) return because(Cause::LidarBlind, Remedy::UncoverLidar, now);
    if (config.lidars.size() > 1 && !names.empty())
      return {notice(Cause::LidarsSilent, {{"name", names}}), notice(Remedy::CheckLidar), now};
    return because(state.lidar_heard ? Cause::LidarSilent : Cause::NoScan, Remedy::CheckLidar, now);
  }
  return {};
}

Standstill why_unplaced(const CycleState& state, Stamp now) {
  if (!state.lidar_heard) return because(Cause::NoScan, Remedy::CheckLidar, now);
  const auto& health = state.pose.health;
  const Cause cause =
      health.state == LocalizationState::Ambiguous ? Cause::PlaceAmbiguous : Cause::PlaceUnknown;
  return {notice(cause, {{"reason", health.reason}}), notice(Remedy::WaitForPlace), now};
}

/// Resume alone helps only where the place is known.
Standstill why_paused(const CycleState& state, Stamp now) {
  if (state.lidar_heard && !may_drive(state.pose.health.state)) return why_unplaced(state, now);
  if (state.elsewhere)
    return {notice(Cause::FoundElsewhere, {{"metres", fmt::format("{:.1f}", state.elsewhere->metres)},
                                           {"degrees", fmt::format("{:.0f}", state.elsewhere->degrees)}}),
            notice(Remedy::LookAtPlaceAndResume), now};
  if (!state.stopped) return because(Cause::Paused, Remedy::Resume, now);
  if (!state.stopped_order) return because(Cause::Stopped, Remedy::LookAndResume, now);
  return {notice(Cause::StoppedOrder, {{"order", std::to_string(*state.stopped_order)}}),
          notice(Remedy::LookAndResume), now};
}

/// While a map is made there is neither an order nor a drawing: nothing to resume.
Standstill why_mapping(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  constexpr double kHeldS = 0.3;
  const Stamp now = input.now;
  if (const auto* rule = forbidding_rule(state, input, config, true))
    return {notice(rule->cause), notice(rule->remedy), now};
  if (state.jog_held && to_seconds(now - *state.jog_held) > kHeldS)
    return because(Cause::SomethingInTheWay, Remedy::ClearAround, now);
  if (state.mode == Mode::Paused && state.stopped)
    return because(Cause::MappingStopped, Remedy::LookAndDrive, now);
  if (!may_drive(state.pose.health.state) || state.pose.health.state == LocalizationState::Degraded)
    return because(Cause::MappingLost, Remedy::DriveBack, now);
  return because(Cause::Mapping, Remedy::DriveToMap, now);
}

Standstill why_at_stop(const CycleState& state, Stamp now) {
  const OrderStop& stop = state.errand.stop;
  if (!is_place_certain(state.pose.health)) {
    const auto percent = std::to_string(std::lround(100.0 * state.pose.health.place));
    return {notice(Cause::StopUnsure, {{"node", std::to_string(stop.node)}, {"percent", percent}}),
            notice(Remedy::LookAtPlace), now};
  }
  if (stop.action == StopAction::Load) return because(Cause::Loading, Remedy::GoOn, now);
  if (stop.action == StopAction::Unload) return because(Cause::Unloading, Remedy::GoOn, now);
  return because(Cause::OrderStop, Remedy::ByItself, now);
}

Standstill why_waiting(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  const Stamp now = input.now;
  if (const auto* rule = forbidding_rule(state, input, config))
    return {rule->said ? rule->said(state, input, config) : notice(rule->cause), notice(rule->remedy), now};
  if (state.errand.arrived) return why_at_stop(state, now);
  if (!state.errand.no_way.empty()) return {state.errand.no_way, notice(Remedy::ClearOrDraw), now};
  if (const auto taken = taken_stop(state, config)) return {*taken, notice(Remedy::ClearOrGoOn), now};
  const auto ask = std::ranges::find_if(asks(), [&](const Ask& a) { return a.holds(state, config); });
  const bool has_reason = std::string_view(ask->remedy.english).find("{reason}") != std::string_view::npos;
  Notice remedy = has_reason ? notice(ask->remedy, {{"reason", state.detour.failed}}) : notice(ask->remedy);
  return {notice(ask->cause), std::move(remedy), now};
}

}  // namespace

Standstill standstill_of(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  if (!drives(state.mode))
    if (auto deaf = why_deaf(state, input.now, config); !deaf.cause.empty()) return deaf;
  if (config.mapping && state.mode != Mode::EmergencyStop && state.mode != Mode::Fault)
    return why_mapping(state, input, config);
  const bool asks_order =
      state.mode == Mode::Idle || state.mode == Mode::Localizing || state.mode == Mode::Paused;
  if (asks_order && mounting_forbids(state.mounting))
    return {mounting_notice(*state.mounting.doubt(), config), notice(Remedy::CorrectMounting), input.now};
  if (state.unarmed_steps > 2 * (kStepsToRun + 1))
    return because(Cause::DriveIdle, Remedy::CheckDrive, input.now);
  switch (state.mode) {
    case Mode::Driving:
    case Mode::Detouring:
      return {};
    case Mode::Manual:
      return because(Cause::Manual, Remedy::ManualOff, input.now);
    case Mode::Idle:
      return {state.errand.no_way.empty() ? notice(Cause::NoOrder) : state.errand.no_way,
              notice(Remedy::GiveOrder), input.now};
    case Mode::Localizing:
      return why_unplaced(state, input.now);
    case Mode::Paused:
      return why_paused(state, input.now);
    case Mode::EmergencyStop:
      return why_emergency(state, input.now);
    case Mode::Fault:
      return why_fault(state, input);
    case Mode::Waiting:
      return why_waiting(state, input, config);
  }
  return {};
}

}  // namespace madori::app
