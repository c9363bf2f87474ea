#include <algorithm>
#include <cmath>
#include <optional>

#include "app/cycle/stages.hpp"
#include "core/angle.hpp"

namespace madori::app {
namespace {

constexpr std::size_t kLongestTrail = 40;
constexpr double kTrailStepM = 0.1;  ///< between the points of a way back, and between lengths that are tried

/// Where the vehicle came from, up to a turn on the spot or the end of what is remembered. Headings are those
/// of the way, not of the vehicle.
std::optional<Path> way_back(const CycleState& state, const CycleConfig& config) {
  constexpr double kWorthM = 0.25;
  constexpr double kStraightRad = 0.4;  ///< between the vehicle's axis and the way that it went
  Path path;
  double length_m = 0.0;
  Transform2<Map, Base> last = state.pose.map_from_base;
  const auto add = [&] {
    path.points.push_back(
        {last.translation(), wrap_angle(last.yaw_rad() + kPi), 0.0, config.back_out_mps, true});
  };
  add();
  for (std::size_t i = state.trail.size(); i-- > 0 && length_m < config.back_out_m;) {
    const Transform2<Map, Base>& pose = state.trail[i];
    const double step_m = distance_m(pose.translation(), last.translation());
    if (step_m < kTrailStepM) continue;
    const double direction = std::atan2(pose.y_m() - last.y_m(), pose.x_m() - last.x_m());
    if (std::abs(wrap_angle(direction - pose.yaw_rad() - kPi)) > kStraightRad) break;
    length_m += step_m;
    last = pose;
    add();
  }
  if (length_m < kWorthM) return std::nullopt;
  return path;
}

/// Straight back, without a turn that would swing the front into what stands beside it.
Path straight_back(const CycleState& state, double length_m, const CycleConfig& config) {
  const Transform2<Map, Base>& here = state.pose.map_from_base;
  Path path;
  const int steps = static_cast<int>(std::lround(length_m / kTrailStepM));
  for (int i = 0; i <= steps; ++i)
    path.points.push_back({here * Point2<Base>{-kTrailStepM * i, 0.0}, wrap_angle(here.yaw_rad() + kPi), 0.0,
                           config.back_out_mps, true});
  return path;
}

/// Nothing seen or drawn behind the vehicle all along; what it stands against before it does not count.
bool is_free_behind(const CycleState& state, const Path& path, const std::vector<Point2<Map>>& obstacles,
                    const CycleConfig& config) {
  constexpr double kEndM = 0.15;  ///< kept free behind, and of the front that is not looked at
  planning::CheckOptions check = config.check;
  check.vehicle.front_m -= 2.0 * kEndM;  // the margin is added at both ends
  check.ends_margin_m = kEndM;
  check.sides_margin_m = 0.0;
  check.protective = {};  // it moves away from what its field would meet
  check.wall_margin_m = -state.block.squeeze.wall_slack_m;
  return std::all_of(path.points.begin(), path.points.end(), [&](const PathPoint& point) {
    const Transform2<Map, Base> pose(point.position.x_m, point.position.y_m, point.facing_rad());
    return planning::is_free(pose, obstacles, *state.site->walls(), check);
  });
}

/// The way that it came; straight back as far as that is free, where that way was held, leads into something
/// or is too short to help.
std::optional<Path> free_way_back(CycleState& state, const CycleConfig& config) {
  constexpr double kShortestM = 0.3;
  const auto& obstacles = obstacle_points(state, config);
  const auto is_free = [&](const Path& path) { return is_free_behind(state, path, obstacles, config); };
  auto came = state.errand.backing_held ? std::nullopt : way_back(state, config);
  if (came && is_free(*came)) return came;
  for (double length_m = config.back_out_m; length_m > kShortestM - 1e-6; length_m -= kTrailStepM)
    if (Path path = straight_back(state, length_m, config); is_free(path)) return path;
  return std::nullopt;
}

}  // namespace

void remember_trail(CycleState& state, Stamp now) {
  constexpr double kTrailM = 0.05;
  constexpr double kTrailRad = 0.1;
  constexpr double kJumpM = 0.3;  ///< no motion: another pose was found
  if (state.mode == Mode::Waiting || state.way.backing) return;
  if (!drives(state.mode)) return state.trail.clear();
  const Transform2<Map, Base>& here = state.pose.map_from_base;
  if (!state.trail.empty()) {
    const double moved_m = distance_m(here.translation(), state.trail.back().translation());
    const double turned_rad = std::abs(wrap_angle(here.yaw_rad() - state.trail.back().yaw_rad()));
    if (moved_m < kTrailM && turned_rad < kTrailRad) return;
    if (moved_m > kJumpM) state.trail.clear();
  }
  state.trail.push_back(here);
  state.trail_at = now;
  if (state.trail.size() > kLongestTrail) state.trail.pop_front();
}

void back_out(CycleState& state, const CycleInput& /*input*/, const CycleConfig& config,
              CycleOutput& output) {
  const auto path = free_way_back(state, config);
  if (!path) return;
  output.events.emplace_back("no way from here: going back the way it came, to have room");
  take_path(state, *path, config);
  state.way.backing = true;
  state.errand.backing_held = false;
  ++state.errand.back_outs;
  state.way.rejoin_m = planning::PathCheck::kFree;  // until it is planned anew
}

void end_back_out(CycleState& state) {
  state.way.backing = false;
  state.way.path = {};
  state.way.plain = {};
  state.trail.clear();
}

}  // namespace madori::app
