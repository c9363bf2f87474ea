#include <algorithm>
#include <cmath>
#include <utility>

#include "app/cycle/stages.hpp"
#include "control/diff_drive/kinematics.hpp"
#include "core/angle.hpp"
#include "planning/obstacle_check/clearance.hpp"

namespace madori::app {
namespace {

constexpr double kFeltBeforeM = 0.05;  ///< from the outline: within every margin

/// A turn as the way of the outline's ends.
double lever_m(const CycleConfig& config) {
  return config.check.vehicle.reach_m();
}

/// Where what holds the vehicle may be, Base frame: all along the bumper, or where it would turn to.
std::vector<Point2<Base>> felt_places(const CycleConfig& config, const VelocityCommand& command) {
  const planning::VehicleOutline& v = config.check.vehicle;
  std::vector<Point2<Base>> places;
  if (std::abs(command.linear_mps) >= std::abs(command.angular_radps) * lever_m(config)) {
    const double x = command.linear_mps > 0.0 ? v.front_m + kFeltBeforeM : -v.rear_m - kFeltBeforeM;
    for (double y = -v.half_width_m; y <= v.half_width_m + 1e-9; y += config.field.cell_m)
      places.push_back({x, y});
    return places;
  }
  const double side = std::copysign(v.half_width_m + kFeltBeforeM, command.angular_radps);
  places.push_back({v.front_m, side});
  places.push_back({-v.rear_m, -side});
  return places;
}

void feel(CycleState& state, const CycleInput& input, const CycleConfig& config) {
  const auto& odom_from_base = state.odometry.reading().odom_from_base;
  std::vector<Point2<Odom>> places;
  for (const auto& place : felt_places(config, state.limits.previous))
    places.push_back(odom_from_base * place);
  state.obstacles.add_felt(places, input.now);
  state.block.felt = true;
  state.ahead.stop_along_m = state.progress.along_m;  // the next revolution looks at it again
}

/// Whether what the drive was already told leads nearer to something than the law allows: no command changes
/// that way any more, but the next one can end it.
bool is_led_into(const CycleState& state, const std::vector<Point2<Map>>& obstacles,
                 const CycleConfig& config) {
  const planning::VehicleOutline& vehicle = config.check.vehicle;
  const auto now_from_map = state.pose.map_from_base.inverse(), then_from_map = state.command_pose.inverse();
  const auto too_near = [&](const auto& shape, double margin_m) {
    const double now_m = planning::clearance_m(vehicle, now_from_map * shape);
    return now_m > 0.0 &&
           planning::clearance_m(vehicle, then_from_map * shape) < std::min(margin_m, 0.5 * now_m);
  };
  const Point2<Map> then = state.command_pose.translation();
  const double near_m = vehicle.reach_m() + config.guard.body_margin_m;
  return std::ranges::any_of(obstacles,
                             [&](const Point2<Map>& p) {
                               return distance_m(p, then) < near_m && too_near(p, config.guard.body_margin_m);
                             }) ||
         state.site->walls()->any_near(then, near_m, [&](const Segment2<Map>& wall) {
           return too_near(wall, config.guard.wall_margin_m);
         });
}

/// Of two wheels that are said to stand, the one that was told to turn faster.
control::DisobedientWheel still_wheel(const VelocityCommand& told, const CycleState& state,
                                      const CycleConfig& config) {
  const double half_m = config.wheel_watch.half_separation_m;
  const auto asked = control::rim_speeds(half_m, told);
  const auto turned =
      control::rim_speeds(half_m, {state.odometry.linear_mps(), state.odometry.angular_radps()});
  const bool left = std::abs(asked.left_mps) >= std::abs(asked.right_mps);
  return {left, left ? asked.left_mps : asked.right_mps, left ? turned.left_mps : turned.right_mps};
}

}  // namespace

double outline_mps(const planning::VehicleOutline& vehicle, const VelocityCommand& command) {
  const double turn = std::abs(command.angular_radps);
  const double sideways = turn * std::max(vehicle.front_m, vehicle.rear_m);
  return std::hypot(std::abs(command.linear_mps) + turn * vehicle.half_width_m, sideways);
}

void watch_wheels(CycleState& state, const CycleInput& input, const CycleConfig& config) {
  const Stamp now = state.odometry.reading().stamp;
  const double step_s = to_seconds(now - std::exchange(state.wheels_at, now));
  if (!(step_s > 0.0)) return;  // no new reading
  const bool obeys = state.drive.state == control::wire::DriveState::Running && step_s < config.gap_s &&
                     !is_drive_late(state, input.now, config);
  const auto found = state.wheels.update(obeys ? std::optional(state.limits.previous) : std::nullopt,
                                         {state.odometry.linear_mps(), state.odometry.angular_radps()},
                                         step_s, config.wheel_watch);
  if (found) state.disobedient = found;
}

void watch_effort(CycleState& state, const CycleInput& input, const CycleConfig& config,
                  CycleOutput& output) {
  constexpr double kShortestS = 2.0;
  constexpr double kLeastAskedM = 0.06;
  constexpr double kLeastShare = 0.25;
  constexpr double kGotOnM = 0.1;
  const VelocityCommand& driven = state.limits.previous;
  const bool tries = drives(state.mode) && state.drive.state == control::wire::DriveState::Running &&
                     !(driven == VelocityCommand{}) && may_drive(state.pose.health.state);
  if (!drives(state.mode) && state.mode != Mode::Waiting) return state.effort.reset();
  const Stamp now = state.odometry.reading().stamp;
  const Transform2<Map, Base>& here = state.pose.map_from_base;
  if (!state.effort) state.effort = Effort{here, now};
  Effort& effort = *state.effort;
  const double step_s = to_seconds(now - std::exchange(effort.at, now));
  if (!tries) return;  // short stops do not hide it
  const double direction = driven.linear_mps < 0.0 ? -1.0 : 1.0;
  if (direction != effort.direction)
    effort = {here, now, 0.0, 0.0, direction};  // what it goes back is no way lost
  effort.driven_s += step_s;
  effort.asked_m += (std::abs(driven.linear_mps) + std::abs(driven.angular_radps) * lever_m(config)) * step_s;
  const double moved_m = distance_m(here.translation(), effort.from.translation()) +
                         std::abs(wrap_angle(here.yaw_rad() - effort.from.yaw_rad())) * lever_m(config);
  // Both wheels are said to stand, and the lidar sees the vehicle get on: the encoders do not work.
  const double lever = lever_m(config);
  const bool turns =
      std::abs(state.odometry.linear_mps()) + std::abs(state.odometry.angular_radps()) * lever >
      kLeastShare * (std::abs(driven.linear_mps) + std::abs(driven.angular_radps) * lever);
  if (moved_m > kGotOnM && turns) {
    effort = {here, now, 0.0, 0.0, direction};
    state.block.felt = false;
    return;
  }
  const bool held =
      effort.driven_s > kShortestS && effort.asked_m > kLeastAskedM && moved_m < kLeastShare * effort.asked_m;
  const bool unseen = effort.driven_s > kShortestS && moved_m > kGotOnM / kLeastShare;
  if (unseen) state.disobedient = still_wheel(driven, state, config);
  if (!held) return;
  output.events.emplace_back(
      "the vehicle drives and does not get on: something that it does not see holds it");
  feel(state, input, config);
  state.effort.reset();
}

double share_to_go(const CycleState& state, const VelocityCommand& wanted,
                   const std::vector<Point2<Map>>& obstacles, const CycleConfig& config) {
  if (is_led_into(state, obstacles, config)) return 0.0;
  return planning::guarded_share(state.command_pose, wanted, obstacles, *state.site->walls(),
                                 config.check.vehicle, braking_once_obeyed(config), config.guard);
}

/// Whether the vehicle moves at least a little as it is wanted to. What is left of a command is no sign of
/// that: before a wall it comes and goes.
bool gets_on(const CycleState& state, const VelocityCommand& wanted) {
  constexpr double kLittle = 0.12;
  const auto moves = [](double is, double asked) {
    return asked != 0.0 && std::abs(is) > kLittle * std::abs(asked);
  };
  return moves(state.odometry.linear_mps(), wanted.linear_mps) ||
         moves(state.odometry.angular_radps(), wanted.angular_radps);
}

VelocityCommand guarded(CycleState& state, const VelocityCommand& wanted, const CycleConfig& config) {
  const bool looks = drives(state.mode) || (config.mapping && state.mode == Mode::Manual);
  if (!looks || wanted == VelocityCommand{}) {
    state.jog_held.reset();
    return wanted;
  }
  const double share = share_to_go(state, wanted, obstacle_points(state, config), config);
  constexpr double kNothingLeft = 0.12;
  if (state.mode != Mode::Manual || gets_on(state, wanted))
    state.jog_held.reset();
  else if (share < kNothingLeft && !state.jog_held)
    state.jog_held = state.previous;
  return {wanted.linear_mps * share, wanted.angular_radps * share};
}

}  // namespace madori::app
