#include <cmath>

#include "app/cycle/stages.hpp"
#include "core/angle.hpp"
#include "localization/placement/placement.hpp"

namespace madori::app {
namespace {

constexpr double kStandsBeforeM =
    0.12;  ///< nearer than this to the stopping point the vehicle counts as blocked
constexpr double kWorthGoingM = 0.5;  ///< less free way than this is not worth a start

/// Whether the way ahead lets the vehicle go on from a standstill.
bool is_clear(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  const bool has_way =
      !state.way.path.empty() && !state.errand.arrived && state.ahead.turn_free && !state.ahead.held;
  const bool room = state.ahead.stop_along_m - state.progress.along_m > kWorthGoingM;
  const bool lasting = !state.block.since || room;
  const bool settled =
      !state.block.free_since || to_seconds(input.now - *state.block.free_since) >= config.clear_for_s;
  return !forbidding_rule(state, input, config) && has_way && room && lasting && settled;
}

bool is_blocked(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  return state.way.path.empty() || state.errand.arrived || !state.ahead.turn_free || state.ahead.held ||
         forbidding_rule(state, input, config) ||
         state.ahead.stop_along_m - state.progress.along_m < kStandsBeforeM;
}

bool is_stop(OperatorWord word) {
  return word == OperatorWord::Stop || word == OperatorWord::Halt;
}

/// Keeps that a person stopped the vehicle, and what that ended, until a person lets it go on.
void note_stop_word(CycleState& state, OperatorWord word) {
  if (word == OperatorWord::Resume) {
    state.stopped = false;
    state.stopped_order.reset();
    state.elsewhere.reset();
  }
  if (!is_stop(word)) return;
  state.stopped = true;
  state.jog = {};
  if (word == OperatorWord::Stop && state.errand.target) state.stopped_order = state.errand.target->order;
}

/// Nobody lifts or turns a vehicle that is to drive by itself. One that finds its place again elsewhere than
/// its wheels led it was carried all the same, has a lidar that was knocked, or is wrong.
std::optional<Elsewhere> found_elsewhere(const CycleState& state) {
  constexpr double kFarDeg = 20.0;
  if (!state.drawing_from_odom) return std::nullopt;
  const auto led = *state.drawing_from_odom * state.odometry.reading().odom_from_base;
  const auto found = state.site->on_drawing(state.pose.map_from_base);
  const Elsewhere by{distance_m(led.translation(), found.translation()),
                     to_deg(std::abs(wrap_angle(found.yaw_rad() - led.yaw_rad())))};
  return by.metres > localization::kAroundM || by.degrees > kFarDeg ? std::optional(by) : std::nullopt;
}

/// Applies events one by one and keeps what they did for the log.
class ModeChanges {
 public:
  ModeChanges(CycleState& state, CycleOutput& output) : state_(state), output_(output) {}

  bool apply(ModeEvent event) {
    const auto next = next_mode(state_.mode, event);
    if (!next) return false;
    output_.events.push_back(std::string(to_string(state_.mode)) + " -> " + to_string(*next) + ": " +
                             to_string(event));
    state_.mode = *next;
    return true;
  }

 private:
  CycleState& state_;
  CycleOutput& output_;
};

/// What the way asks for while an order is worked on.
std::optional<ModeEvent> way_event(const CycleState& state, const CycleInput& input,
                                   const CycleConfig& config) {
  const bool on_detour = state.way.rejoin_m && state.progress.along_m < *state.way.rejoin_m;
  if (!state.errand.target) return ModeEvent::OrderEnded;
  if (state.mode == Mode::Waiting) {
    if (!is_clear(state, input, config)) return std::nullopt;
    return on_detour ? ModeEvent::DetourFound : ModeEvent::Cleared;
  }
  if (is_blocked(state, input, config)) return ModeEvent::Blocked;
  if (state.mode == Mode::Driving && on_detour) return ModeEvent::DetourFound;
  if (state.mode == Mode::Detouring && !on_detour) return ModeEvent::BackOnRoute;
  return std::nullopt;
}

}  // namespace

std::optional<ModeEvent> event_of(OperatorWord word) {
  switch (word) {
    case OperatorWord::Pause:
    case OperatorWord::Stop:
    case OperatorWord::Halt:
      return ModeEvent::Pause;
    case OperatorWord::Resume:
      return ModeEvent::Resume;
    case OperatorWord::Confirm:
      return ModeEvent::Confirmed;
    case OperatorWord::ManualOn:
      return ModeEvent::ManualOn;
    case OperatorWord::ManualOff:
      return ModeEvent::ManualOff;
    default:
      return std::nullopt;
  }
}

bool is_silent(const std::optional<Stamp>& heard, Stamp now, double limit_s) {
  return !heard || to_seconds(now - *heard) > limit_s;
}

bool is_drive_deaf(const CycleState& state, Stamp now, const CycleConfig& config) {
  return state.drive_deaf && to_seconds(now - *state.drive_deaf) > config.drive_silent_s;
}

bool is_drive_late(const CycleState& state, Stamp now, const CycleConfig& config) {
  return !is_silent(state.drive_late, now, config.drive_silent_s);
}

bool are_wheels_untold(const CycleState& state, Stamp now, const CycleConfig& config) {
  return state.drive_heard && !state.gap &&
         is_silent(state.odometry.reading().stamp, now, config.drive_silent_s);
}

bool may_drive(LocalizationState state) {
  return state == LocalizationState::Localized || state == LocalizationState::Degraded;
}

bool is_placed(const CycleState& state) {
  return may_drive(state.pose.health.state) && state.lidar_heard.has_value();
}

bool is_place_certain(const LocalizationHealth& health) {
  constexpr double kCertain = 0.95;  // as LOCALIZED asks for, whatever else degrades the pose
  return health.state == LocalizationState::Localized || health.place >= kCertain;
}

void change_mode(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output) {
  ModeChanges mode(state, output);
  const bool stopped = state.drive_stopped;
  const bool fault = state.drive_faulty;
  const bool deaf = is_silent(state.drive_heard, input.now, config.drive_silent_s);
  if (stopped) mode.apply(ModeEvent::EmergencyOn);
  if (fault || state.disobedient) mode.apply(ModeEvent::FaultOn);
  for (const OperatorCommand& command : input.commands) {
    const auto event = event_of(command.word);
    if (event == ModeEvent::Confirmed && (stopped || fault || deaf)) continue;  // the cause is still there
    if (event == ModeEvent::Confirmed) state.disobedient.reset();
    note_stop_word(state, command.word);
    if (command.word == OperatorWord::SetPose || command.word == OperatorWord::SearchPose)
      state.drawing_from_odom.reset();
    if (is_stop(command.word)) mode.apply(ModeEvent::ManualOff);
    if (event) mode.apply(*event);
    if (command.word == OperatorWord::Jog) {
      state.jog = command.jog;
      state.jog_heard = input.now;
    }
  }
  if (is_held(state.mode)) return state.drawing_from_odom.reset();
  const bool sure = is_placed(state);
  if (sure && state.mode == Mode::Localizing) state.elsewhere = found_elsewhere(state);
  if (state.elsewhere) {
    mode.apply(ModeEvent::Pause);
    return;
  }
  if (sure)
    state.drawing_from_odom =
        state.site->on_drawing(state.pose.map_from_base) * state.odometry.reading().odom_from_base.inverse();
  mode.apply(sure ? ModeEvent::Localized : ModeEvent::Lost);
  if (state.mode == Mode::Idle && sure && state.errand.target && !state.way.path.empty())
    mode.apply(ModeEvent::OrderGiven);
  else if (drives(state.mode) || state.mode == Mode::Waiting)
    if (const auto event = way_event(state, input, config)) mode.apply(*event);
}

}  // namespace madori::app
