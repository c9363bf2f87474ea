#include <algorithm>
#include <cmath>
#include <utility>

#include "app/cycle/stages.hpp"
#include "localization/health/reasons.hpp"

namespace madori::app {
namespace {

/// Every comparison with what is not a number is false: nothing would be near, and no doubt large.
bool is_finite(const PoseEstimate& pose) {
  return pose.map_from_base.is_finite() && pose.moved.is_finite() && pose.covariance.allFinite();
}

constexpr double kOwnRoomM = 0.05;  ///< nothing that is only supposed stands so near: it would have been felt

/// How the odometry lay on the map when a column was last seen; `now` where it still does. Further than
/// odometry drifts the vehicle has believed to be elsewhere, or was carried: then the way driven since tells.
Transform2<Map, Odom> map_from_odom_of(const CycleState& state, const planning::Column& column,
                                       const Transform2<Map, Odom>& now) {
  constexpr double kMostDriftM = 0.5;
  const auto after = std::ranges::upper_bound(state.anchors, column.seen, {}, &Anchor::at);
  if (after == state.anchors.begin() || after == state.anchors.end()) return now;
  const Transform2<Map, Odom>& then = (after - 1)->map_from_odom;
  return distance_m(then * column.centre(), now * column.centre()) < kMostDriftM ? then : now;
}

/// The corners of what was seen of a column.
template <class Visit>
void each_corner(const planning::Column& c, const Transform2<Map, Odom>& map_from_odom, const Visit& visit) {
  for (const float x : {c.min_x_m, c.max_x_m})
    for (const float y : {c.min_y_m, c.max_y_m})
      visit(map_from_odom * Point2<Odom>{static_cast<double>(x), static_cast<double>(y)});
}

/// Where a column may go on below the lowest beam.
template <class Visit>
void each_hidden_place(const planning::Column& c, const Transform2<Map, Odom>& map_from_odom,
                       const planning::FieldOptions& field, const Visit& visit) {
  if (!c.has_hidden_part()) return;
  for (double away_m = field.cell_m; away_m < field.hidden_m + 0.5 * field.cell_m; away_m += field.cell_m)
    visit(map_from_odom * c.hidden_at(away_m));
}

}  // namespace

Transform2<Map, Odom> map_from_odom_now(const CycleState& state) {
  return state.pose.map_from_base * state.odometry.reading().odom_from_base.inverse();
}

void take_pose(CycleState& state, PoseEstimate pose) {
  if (!is_finite(pose)) {
    state.pose.health = {LocalizationState::Lost, localization::reason::kNoPlace.english};
    return;
  }
  state.pose = std::move(pose);
  const auto before = std::exchange(state.moved, state.pose.moved);
  if (distance_m(before.translation(), state.moved.translation()) == 0.0 &&
      before.yaw_rad() == state.moved.yaw_rad())
    return;
  const Transform2<Map, Map> by = state.moved * before.inverse();
  for (Anchor& anchor : state.anchors) anchor.map_from_odom = by * anchor.map_from_odom;
  for (Transform2<Map, Base>& place : state.trail) place = by * place;
}

void note_anchor(CycleState& state, Stamp stamp) {
  constexpr double kEveryS = 0.5;
  constexpr std::size_t kMost = 3600;
  const double since_s = state.anchors.empty() ? kEveryS : to_seconds(stamp - state.anchors.back().at);
  if (since_s <= -kEveryS) state.anchors.clear();  // the clock was set; two lidars' sweeps differ by less
  if (!may_drive(state.pose.health.state) || std::abs(since_s) < kEveryS) return;
  state.anchors.push_back({stamp, map_from_odom_now(state)});
  if (state.anchors.size() > kMost) state.anchors.pop_front();
}

const std::vector<Point2<Map>>& obstacle_points(CycleState& state, const CycleConfig& config) {
  const auto map_from_odom = map_from_odom_now(state);
  const auto base_from_map = state.pose.map_from_base.inverse();
  const auto own = config.check.vehicle.grown(kOwnRoomM, kOwnRoomM);
  auto& points = state.bench.obstacles;
  points.clear();
  for (const planning::Column& c : state.obstacles.columns()) {
    if (!c.confirmed) continue;
    const auto then = map_from_odom_of(state, c, map_from_odom);
    each_corner(c, then, [&](const Point2<Map>& at) { points.push_back(at); });
    each_hidden_place(c, then, config.field, [&](const Point2<Map>& at) {
      if (!own.contains(base_from_map * at)) points.push_back(at);
    });
  }
  for (const MoverWatch& watch : state.movers)
    for (const Point2<Odom>& p : watch.out_of_sight.points()) points.push_back(map_from_odom * p);
  return points;
}

bool is_unseen(const CycleState& state, const Point2<Map>& where, Stamp now, const CycleConfig& config) {
  constexpr double kLatelyS = 0.5;
  const auto now_lies = map_from_odom_now(state);
  const Point2<Odom> place = now_lies.inverse() * where;
  bool known = false;
  for (const MoverWatch& watch : state.movers)
    for (const Point2<Odom>& p : watch.out_of_sight.points())
      known = known || distance_m(p, place) < 0.5 * config.field.cell_m;
  for (const planning::Column& c : state.obstacles.columns()) {
    if (!c.confirmed) continue;
    const auto map_from_odom = map_from_odom_of(state, c, now_lies);
    bool there = false;
    each_hidden_place(c, map_from_odom, config.field, [&](const Point2<Map>& p) {
      known = known || distance_m(p, where) < 0.5 * config.field.cell_m;
    });
    each_corner(c, map_from_odom,
                [&](const Point2<Map>& p) { there = there || distance_m(p, where) <= config.field.cell_m; });
    if (!there) continue;
    if (to_seconds(now - std::max(c.seen, c.under)) <= kLatelyS) return false;
    known = true;
  }
  return known;
}

}  // namespace madori::app
