#include <algorithm>
#include <cmath>

#include "app/cycle/stages.hpp"
#include "core/angle.hpp"

namespace madori::app {
namespace {

/// What crosses the way, Map frame, by all lidars that are heard.
std::vector<planning::Mover<Map>>& movers_on_map(CycleState& state, Stamp now, const CycleConfig& config) {
  const auto map_from_odom = map_from_odom_now(state);
  const Transform2<Map, Odom> turn(0.0, 0.0, map_from_odom.yaw_rad());
  auto& movers = state.bench.movers;
  movers.clear();
  for (std::size_t i = 0; i < state.movers.size(); ++i) {
    const double lasts_s = patience_s(config, i) + config.lidars[i].period_s;
    if (to_seconds(now - state.movers[i].looked) > lasts_s) continue;
    for (const auto& m : state.movers[i].objects.movers()) {
      const Point2<Map> velocity = turn * Point2<Odom>{m.vx_mps, m.vy_mps};
      movers.push_back({map_from_odom * m.at, velocity.x_m, velocity.y_m, m.radius_m});
    }
  }
  return movers;
}

/// Whether the vehicle turns on the spot, or is about to.
bool may_turn(const CycleState& state, const CycleConfig& config) {
  if (state.progress.pursuit.begun) return state.progress.pursuit.turning;
  if (state.way.path.empty()) return false;
  const double off_rad =
      wrap_angle(state.way.path.points().front().facing_rad() - state.command_pose.yaw_rad());
  return std::abs(off_rad) > config.pursuit.turn_first_rad;
}

/// Whether the vehicle can turn on the spot to where its path goes next.
bool turn_is_free(CycleState& state, const std::vector<Point2<Map>>& obstacles,
                  const planning::CheckOptions& margins) {
  static const planning::WallGrid kNoWalls;
  if (state.progress.pursuit.piece >= state.way.path.pieces().size()) return true;
  const PathPoint& next =
      state.way.path.points()[state.way.path.pieces()[state.progress.pursuit.piece].first];
  const Point2<Map> here = state.command_pose.translation();
  Path& turn = state.bench.turn;
  turn.points.assign(2, PathPoint{here, state.command_pose.yaw_rad()});
  turn.points.back().heading_rad = next.facing_rad();
  return !state.bench.checker.check(turn, 1, 0.0, obstacles, kNoWalls, margins).blocked();
}

/// How far the drawn walls reach into the vehicle that stands there: the drawing or the pose is off by so
/// much. What the lidar sees is checked all the same. 0 where it is more than a drawing may be off by.
double wall_slack_m(const CycleState& state, const CycleConfig& config, double share) {
  constexpr double kStepM = 0.05;
  constexpr double kMostM = 0.1;
  for (double slack_m = 0.0; slack_m <= kMostM + 1e-9; slack_m += kStepM)
    if (planning::is_free(state.pose.map_from_base, {}, *state.site->walls(),
                          planning::with_margins(config.check, {share, slack_m})))
      return slack_m;
  return 0.0;
}

/// What the way is checked against. A vehicle that goes with less than all margins, since it stands within
/// them, may leave what it stands beside.
const std::vector<Point2<Map>>& to_pass(CycleState& state, const std::vector<Point2<Map>>& obstacles,
                                        const planning::Squeeze& squeeze, const CycleConfig& config) {
  if (squeeze.share >= 1.0) return obstacles;
  auto& passable = state.bench.set_back;
  passable = obstacles;
  planning::set_back(passable, state.pose.map_from_base, planning::with_margins(config.check, squeeze));
  return passable;
}

/// Whether the vehicle stands free with so much of the margins, and its next metres are free too.
bool passes(CycleState& state, const std::vector<Point2<Map>>& seen, const planning::Squeeze& squeeze,
            const CycleConfig& config) {
  constexpr double kAheadM = 3.0;  ///< what is further away is judged when the vehicle gets there
  const planning::CheckOptions margins = planning::with_margins(config.check, squeeze);
  const auto& obstacles = to_pass(state, seen, squeeze, config);
  const planning::WallGrid& walls = *state.site->walls();
  if (!planning::is_free(state.pose.map_from_base, obstacles, walls, margins)) return false;
  if (may_turn(state, config) && !turn_is_free(state, obstacles, margins)) return false;
  const std::size_t from = std::min(state.progress.pursuit.index, state.way.plain.points.size() - 1);
  return !state.bench.checker.check(state.way.plain, from, kAheadM, obstacles, walls, margins).blocked();
}

/// What is kept of the ordinary margins. Where no way with all of them has shown itself for a while, because
/// the place is narrow or the vehicle has come to stand within them, it goes with less and slowly, until the
/// next metres allow all of them again.
planning::Squeeze squeeze_here(CycleState& state, const std::vector<Point2<Map>>& obstacles, Stamp now,
                               const CycleConfig& config) {
  constexpr double kHalf = 0.5;
  constexpr double kLeast = 0.2;
  constexpr double kAllAgain = 1.5;  ///< more than all of them: what is seen of a body flickers
  const auto passes_with = [&](const planning::Squeeze& squeeze) {
    return passes(state, obstacles, squeeze, config);
  };
  const bool squeezes = state.block.squeeze.share < 1.0;
  const bool stands = state.mode == Mode::Waiting && state.block.since && !state.block.by_mover &&
                      to_seconds(now - *state.block.since) > config.squeeze_after_s;
  if (passes_with({squeezes ? kAllAgain : 1.0, 0.0})) return {};
  if (!stands) return state.block.squeeze;
  if (passes_with({kHalf, 0.0})) return {kHalf, 0.0};
  const planning::Squeeze least{kLeast, wall_slack_m(state, config, kLeast)};
  if (passes_with(least)) return least;
  const bool long_since = to_seconds(now - *state.block.since) > 2.0 * config.squeeze_after_s;
  return long_since ? least : planning::Squeeze{kHalf, 0.0};  // a way around may do with so much
}

/// Whether something has seemed to move for long at one place, so that it does not: the edge of something
/// remembered can look like a mover. What it is stops the vehicle as a body, if it is in its way.
bool stays(std::vector<Stirring>& stirring, const Point2<Map>& where, Stamp now, double limit_s) {
  constexpr double kOnePlaceM = 0.5;
  auto same = std::find_if(stirring.begin(), stirring.end(),
                           [&](const Stirring& s) { return distance_m(s.at, where) < kOnePlaceM; });
  if (same == stirring.end()) same = stirring.insert(same, {where, now, now});
  same->last = now;
  return to_seconds(now - same->since) > limit_s;
}

/// What gets anywhere, Map frame.
const std::vector<planning::Mover<Map>>& true_movers(CycleState& state, Stamp now,
                                                     const CycleConfig& config) {
  constexpr double kGapS = 1.0;
  auto& stirring = state.block.stirring;
  std::erase_if(stirring, [&](const Stirring& s) { return to_seconds(now - s.last) > kGapS; });
  auto& movers = movers_on_map(state, now, config);
  std::erase_if(movers,
                [&](const auto& m) { return stays(stirring, m.at, now, config.mover_stays_after_s); });
  return movers;
}

/// What is free for a moment only, by the noise of what is seen, is blocked all along.
void note_blocked(CycleState& state, Stamp now, double clear_for_s) {
  const bool blocked = state.ahead.check.blocked() || !state.ahead.turn_free || state.ahead.held;
  if (blocked) {
    state.block.free_since.reset();
    if (!state.block.since) state.block.since = now;
  } else {
    if (!state.block.free_since) state.block.free_since = now;
    if (to_seconds(now - *state.block.free_since) >= clear_for_s) state.block.since.reset();
  }
}

void check_ahead(CycleState& state, const std::vector<Point2<Map>>& seen, Stamp now,
                 const CycleConfig& config) {
  const auto& obstacles = to_pass(state, seen, state.block.squeeze, config);
  const std::size_t from = std::min(state.progress.pursuit.index, state.way.plain.points.size() - 1);
  const auto margins = planning::with_margins(config.check, state.block.squeeze);
  state.ahead.check = state.bench.checker.check(state.way.plain, from, config.look_ahead_m, obstacles,
                                                *state.site->walls(), margins);
  const auto& movers = true_movers(state, now, config);
  const auto crossing =
      planning::check_movers(state.way.plain, from, config.look_ahead_m, state.limits.previous.linear_mps,
                             movers, config.check, config.movers);
  state.block.by_mover = crossing.free_m < state.ahead.check.free_m;
  if (state.block.by_mover) state.ahead.check = crossing;
  state.block.unseen = state.ahead.check.blocked() && !state.ahead.check.by_wall && !state.block.by_mover &&
                       is_unseen(state, state.ahead.check.where, now, config);
  const double from_m = state.way.path.along_m(from);
  state.ahead.stop_along_m = from_m + state.ahead.check.free_m;
  state.ahead.care_along_m = from_m + state.ahead.check.care_m;
  state.ahead.turn_free = !may_turn(state, config) || (turn_is_free(state, obstacles, margins) &&
                                                       !planning::turn_meets(state.pose.map_from_base, movers,
                                                                             config.check, config.movers));
}

/// Back the way it came: the guard looks at what stands there, here at who comes there.
void check_behind(CycleState& state, Stamp now, const CycleConfig& config) {
  const std::size_t from = std::min(state.progress.pursuit.index, state.way.plain.points.size() - 1);
  state.ahead.check = planning::check_movers(state.way.plain, from, config.look_ahead_m,
                                             std::abs(state.limits.previous.linear_mps),
                                             true_movers(state, now, config), config.check, config.movers);
  state.block.by_mover = state.ahead.check.blocked();
  state.block.unseen = false;
  state.ahead.turn_free = true;
  state.block.squeeze = {};
  state.ahead.stop_along_m = state.way.path.along_m(from) + state.ahead.check.free_m;
  state.ahead.care_along_m = planning::PathCheck::kFree;
}

/// Whether what the vehicle would do next is not to be done: it leads into something beside the path. A
/// moment's shape of the noise does not count.
void note_held(CycleState& state, const std::vector<Point2<Map>>& obstacles, const CycleInput& input,
               const CycleConfig& config) {
  constexpr double kNothingLeft = 0.12;
  constexpr double kMomentS = 0.25;
  const bool going = drives(state.mode) || state.mode == Mode::Waiting;
  const VelocityCommand next = going ? pursue_way(state, input, config).command : VelocityCommand{};
  const double share = share_to_go(state, next, obstacles, config);
  if (share > kNothingLeft)
    state.ahead.held_since.reset();
  else if (!state.ahead.held_since)
    state.ahead.held_since = input.now;
  state.ahead.held = state.ahead.held_since && to_seconds(input.now - *state.ahead.held_since) >= kMomentS;
}

/// The operator has looked at what was said to stand in the way, and at what the vehicle stands against. What
/// is remembered elsewhere, out of the lidar's sight, is still there.
void forget_what_was_looked_at(CycleState& state) {
  constexpr double kAroundM = 1.0;
  state.block.felt = false;
  for (MoverWatch& watch : state.movers) watch.out_of_sight.clear();
  state.obstacles.forget_near(state.odometry.reading().odom_from_base.translation(), kAroundM);
  if (state.ahead.check.blocked())
    state.obstacles.forget_near(map_from_odom_now(state).inverse() * state.ahead.check.where, kAroundM);
}

}  // namespace

void check_way(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output) {
  for (const auto& command : input.commands)
    if (command.word == OperatorWord::GoOn) allow_door(state, config);
  for (const auto& command : input.commands)
    if (command.word == OperatorWord::ForgetObstacles ||
        (command.word == OperatorWord::Resume && (state.mode == Mode::Waiting || state.block.felt))) {
      forget_what_was_looked_at(state);
      if (state.way.rejoin_m) take_path(state, {}, config);  // nothing to drive around any more: planned anew
    }
  if (state.way.path.empty() || state.errand.arrived || !output.computed_lidar) return;
  const auto& obstacles = obstacle_points(state, config);
  if (state.way.backing)
    check_behind(state, input.now, config);
  else
    check_ahead(state, obstacles, input.now, config);
  stop_before_doors(state, config);
  note_held(state, obstacles, input, config);
  if (state.way.backing && state.ahead.held) {
    state.errand.backing_held = true;
    return end_back_out(state);
  }
  note_blocked(state, input.now, config.clear_for_s);
}

void squeeze(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output) {
  if (state.way.path.empty() || state.errand.arrived || !output.computed_lidar) return;
  state.block.squeeze = squeeze_here(state, obstacle_points(state, config), input.now, config);
}

void ask_for_detour(CycleState& state, const CycleInput& input, const CycleConfig& config,
                    CycleOutput& output) {
  if (state.way.path.empty() || state.errand.arrived || !output.computed_lidar) return;
  state.detour.asked = input.now;
  state.detour.pending = true;
  ++state.detour.id;
  const bool stuck = !state.ahead.turn_free || state.ahead.held;
  planning::PathCheck check = state.ahead.check;
  if (!check.blocked()) check.first_blocked = check.last_blocked = state.progress.pursuit.index;
  const auto goal = state.site->routes().index_of(state.errand.stop.node);
  const bool any_end_heading = goal && !state.site->routes().nodes()[*goal].heading_rad;
  const auto& obstacles = to_pass(state, obstacle_points(state, config), state.block.squeeze, config);
  output.detour_wanted = planning::DetourRequest{
      state.detour.id, state.way.plain,    state.progress.pursuit.index, state.pose.map_from_base,
      check,           obstacles,          state.block.squeeze,          any_end_heading,
      !stuck,          state.site->walls()};
}

}  // namespace madori::app
