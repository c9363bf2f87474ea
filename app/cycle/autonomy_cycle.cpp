#include <algorithm>
#include <cmath>
#include <utility>

#include "app/cycle/recoveries.hpp"
#include "app/cycle/stages.hpp"
#include "core/fill_in.hpp"

namespace madori::app {

CycleState::CycleState(const CycleConfig& config, std::unique_ptr<PoseSource> source)
    : odometry(config.odometry),
      localization(std::move(source)),
      site(std::make_shared<const SiteInBuilding>(config.routes, config.walls)),
      obstacles(config.field),
      movers(config.lidars.size(), MoverWatch{{}, planning::MovingObjects(config.movers), {}}) {
  pose.health = {LocalizationState::Lost, "no scan yet"};
  std::vector<Point2<Map>> places;
  for (const auto& node : config.routes.nodes()) places.push_back(node.position);
  if (localization) localization->set_places(places);
}

namespace {

/// Whether the drive shall be enabled. It arms itself on a command without enable only: one that came back
/// while all commands were enabled (its link opened late, it restarted) is given such a one every 10 steps.
bool enables(CycleState& state, bool may_move) {
  const auto drive = state.drive.state;
  const bool idle = drive == control::wire::DriveState::Idle;
  const bool wanted = may_move && (idle || drive == control::wire::DriveState::Running);
  state.unarmed_steps = wanted && idle ? state.unarmed_steps + 1 : 0;
  return wanted && (!idle || state.unarmed_steps % (kStepsToRun + 1) > 0);
}

/// No step came for so long that the drive has stopped by itself, and that what was heard is of another time:
/// the vehicle stands until something was measured after it.
void begin_gap(CycleState& state, double seconds, CycleOutput& output) {
  state.gap = state.previous;
  state.limits = {};
  state.sent.clear();
  state.jog = {};
  output.events.push_back(fill_in(kTimeGapEvent.english, {{"seconds", two_decimals(seconds)}}));
}

/// What the vehicle would do were there no limits: by hand what the person holds down, else along its path.
VelocityCommand wanted_command(CycleState& state, const CycleInput& input, const CycleConfig& config) {
  if (state.mode == Mode::Manual)
    return to_seconds(input.now - state.jog_heard) <= config.jog_timeout_s ? state.jog : VelocityCommand{};
  if (!drives(state.mode)) return {};
  Pursued pursued = pursue_way(state, input, config);
  state.progress = pursued.progress;
  if (state.progress.status == control::PursuitStatus::Arrived) arrive(state, input.now);
  return pursued.command;
}

/// By hand as far as is seen to be free; who drives without a lidar looks himself, and creeps.
double by_hand_mps(const CycleState& state, const CycleInput& input, const CycleConfig& config) {
  return std::max(config.out_of_field_mps,
                  config.check.braking.speed_within(sure_range_m(state, input.now, config)));
}

/// No point of the vehicle faster than it may be: by itself for the sake of whom it does not see, by hand
/// while it is driven out of a protective field, or as far as is seen.
VelocityCommand slowed(const CycleState& state, const VelocityCommand& wanted, const CycleInput& input,
                       const CycleConfig& config) {
  double most_mps = planning::PathCheck::kFree;
  if (drives(state.mode)) most_mps = unseen_bodies_mps(state, input.now, config);
  if (state.mode == Mode::Manual)
    most_mps = input.protective_stop ? config.out_of_field_mps : by_hand_mps(state, input, config);
  const double fastest_mps = outline_mps(config.check.vehicle, wanted);
  const double share = fastest_mps > most_mps ? most_mps / fastest_mps : 1.0;
  return {wanted.linear_mps * share, wanted.angular_radps * share};
}

/// What the drive is told: no faster than vehicle and brakes allow, nothing where a safety rule holds.
void command_drive(CycleState& state, const VelocityCommand& wanted, const CycleInput& input, double step_s,
                   const CycleConfig& config, CycleOutput& output) {
  const bool by_hand = state.mode == Mode::Manual;
  const bool may_move = (drives(state.mode) || by_hand) && !forbidding_rule(state, input, config, by_hand);
  const double cap_mps =
      drives(state.mode) ? allowed_mps(state, input, config) : by_hand_mps(state, input, config);
  output.enable = enables(state, may_move);
  // Wheels that do not turn yet gain no speed meanwhile.
  const bool obeys = output.enable && state.drive.state == control::wire::DriveState::Running;
  const auto limited = control::limit(
      state.limits, {.requested = wanted, .may_move = obeys, .speed_cap_mps = cap_mps, .step_s = step_s},
      config.limits);
  state.limits = limited.state;
  output.command = limited.command;
  state.sent.add(input.now, output.command, config.response);
}

/// Why it stands, where it does; said once. Nobody reads faster than five times a
/// second, but what was said before the mode or the place changed is not true any more.
void say_why(CycleState& state, const CycleInput& input, const CycleConfig& config, double step_s,
             const std::pair<Mode, LocalizationState>& before, CycleOutput& output) {
  constexpr double kOftenS = 0.2;
  const double now_s = to_seconds(input.now.time_since_epoch());
  const bool again = std::floor(now_s / kOftenS) != std::floor((now_s - step_s) / kOftenS);
  if (!again && before == std::pair(state.mode, state.pose.health.state)) return;
  const Standstill now = standstill_of(state, input, config);
  state.standstill.remedy = now.remedy;  // it may change while the cause lasts
  if (now.cause == state.standstill.cause) return;
  state.standstill = now;
  if (!now.cause.empty())
    output.events.push_back(std::string(to_string(state.mode)) + ": " + now.cause.text + " - " +
                            now.remedy.text);
}

}  // namespace

StepResult step(CycleState state, const CycleInput& input, const CycleConfig& config) {
  CycleOutput output;
  const double step_s = state.previous ? to_seconds(input.now - *state.previous) : 0.0;
  const std::pair before(state.mode, state.pose.health.state);
  if (!state.previous) state.begun = input.now;
  state.previous = input.now;
  if (step_s > config.gap_s) begin_gap(state, step_s, output);
  localize(state, input, config, output);  // wheel angles and revolutions -> map_from_base, bodies, movers
  foresee(state, input.now, config);       // pose, commands on their way -> command_pose
  watch_mounting(state, input, config, output);     // height, tilt, yaw: as typed?
  say_missed_lidars(state, input, config, output);  // one of several is silent
  remember_trail(state, input.now);
  watch_wheels(state, input, config);          // told, but not done: a wheel disobeys
  watch_effort(state, input, config, output);  // driven, but not moved: something holds the vehicle
  navigate(state, input, config, output);      // order -> errand -> route -> way
  check_way(state, input, config, output);     // way against bodies and drawing -> ahead, block
  recover(state, input, config, output);       // where the way is not free: what is due of the table
  change_mode(state, input, config, output);   // what happened -> what the vehicle is about
  say_floor_unseen(state, input, config, output);
  const VelocityCommand wanted = wanted_command(state, input, config);  // way, ahead -> progress, command
  const VelocityCommand slow = slowed(state, wanted, input, config);    // as what is not seen allows
  const VelocityCommand safe = guarded(state, slow, config);            // it leads into nothing
  command_drive(state, safe, input, step_s, config, output);            // always last
  say_why(state, input, config, step_s, before, output);
  return {std::move(state), std::move(output)};
}

}  // namespace madori::app
