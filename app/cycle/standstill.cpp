#include <algorithm>

#include "app/cycle/stages.hpp"

namespace madori::app {
namespace {

using control::wire::DriveState;

Standstill because(std::string cause, std::string remedy, Stamp now) {
  return {std::move(cause), std::move(remedy), now};
}

Standstill why_emergency(const CycleState& state, Stamp now) {
  if (state.drive.bumper || state.drive.state == DriveState::BumperStop)
    return because("the bumper is pressed", "free the vehicle, then confirm", now);
  if (state.drive.emergency_stop || state.drive.state == DriveState::EmergencyStop)
    return because("the emergency stop is pressed", "release it when all is safe, then confirm", now);
  return because("the vehicle was stopped by emergency stop or bumper", "look around, then confirm", now);
}

Standstill why_fault(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  if (is_silent(state.drive_heard, input.now, config.drive_silent_s))
    return because("the drive does not answer", "check its power and its cable, then confirm", input.now);
  if (state.drive.faults != control::wire::kNoFault || state.drive.state == DriveState::Fault)
    return because("the drive reports fault " + std::to_string(state.drive.faults),
                   "see the list of drive faults, mend it, then confirm", input.now);
  return because("the drive had a fault, which is gone", "confirm", input.now);
}

Standstill why_waiting(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  const Navigation& way = state.way;
  if (is_silent(state.lidar_heard, input.now, config.lidar_silent_s))
    return because("the lidar is silent", "check its power and network cable", input.now);
  if (state.protective_stop)
    return because("the safety scanner's protective field is interrupted", "clear the field", input.now);
  if (way.arrived) {
    if (way.stop.action == StopAction::Load)
      return because("loading", "goes on by itself, or press Go on", input.now);
    if (way.stop.action == StopAction::Unload)
      return because("unloading", "goes on by itself, or press Go on", input.now);
    return because("stop of the order", "goes on by itself", input.now);
  }
  if (!way.no_way.empty()) return because(way.no_way, "clear the way, or draw a route", input.now);
  if (!way.turn_free) return because("no room to turn", "clear the space around the vehicle", input.now);
  if (is_at_door(config, way.check.where))
    return because("a door or lift is not open far enough", "it goes on by itself once open", input.now);
  if (way.check.by_wall)
    return because("the way leads too close to a drawn wall", "move the route, or erase the wall", input.now);
  return because(
      "something stands in the way",
      way.detour_failed.empty() ? "it goes on by itself once clear" : "clear the way: " + way.detour_failed,
      input.now);
}

}  // namespace

Standstill standstill_of(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  switch (state.mode) {
    case Mode::Driving:
    case Mode::Detouring:
      return {};
    case Mode::Manual:
      return because("manual mode", "switch it off to go on", input.now);
    case Mode::Idle:
      return because(state.way.no_way.empty() ? "no order" : state.way.no_way, "give an order", input.now);
    case Mode::Localizing:
      return because(state.lidar_heard ? "not sure where the vehicle is: " + state.pose.health.reason
                                       : "no scan has come yet",
                     state.lidar_heard ? "wait, move it by hand, or tap its place on the panel"
                                       : "check the lidar's power and network cable",
                     input.now);
    case Mode::Paused:
      return because("paused", "press Resume", input.now);
    case Mode::EmergencyStop:
      return why_emergency(state, input.now);
    case Mode::Fault:
      return why_fault(state, input, config);
    case Mode::Waiting:
      return why_waiting(state, input, config);
  }
  return {};
}

}  // namespace madori::app
