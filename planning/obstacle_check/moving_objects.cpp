#include "planning/obstacle_check/moving_objects.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "planning/waypoints/waypoints.hpp"

namespace madori::planning {

Mover<Odom> MovingObjects::Track::mover() const {
  const Sighting& a = sightings.front();
  const Sighting& b = sightings.back();
  const double time_s = to_seconds(b.stamp - a.stamp);
  if (!(time_s > 0.0)) return {b.at, 0.0, 0.0, radius_m};
  return {b.at, (b.at.x_m - a.at.x_m) / time_s, (b.at.y_m - a.at.y_m) / time_s, radius_m};
}

MovingObjects::Track* MovingObjects::followed_by(const ColumnGroups::Group& group, Stamp stamp) {
  Track* best = nullptr;
  double best_m = options_.match_m;
  for (Track& track : tracks_) {
    if (track.sightings.empty()) continue;  // given to another group
    const Mover<Odom> m = track.mover();
    const double time_s = to_seconds(stamp - track.sightings.back().stamp);
    const double away_m =
        distance_m(group.centre, Point2<Odom>{m.at.x_m + m.vx_mps * time_s, m.at.y_m + m.vy_mps * time_s});
    if (away_m >= best_m) continue;
    best_m = away_m;
    best = &track;
  }
  return best;
}

void MovingObjects::update(const std::vector<Column>& columns, Stamp stamp) {
  lost_.clear();
  for (const ColumnGroups::Group& group : groups_.find(columns, stamp, options_.widest_m)) {
    Track* before = followed_by(group, stamp);
    Track track = spare_.take();
    if (before != nullptr)
      std::swap(track, *before);
    else
      track.since = stamp;
    track.sightings.push_back({stamp, group.centre});
    track.radius_m = group.radius_m;
    track.high_m = std::max(track.high_m, group.high_m);
    while (static_cast<int>(track.sightings.size()) > options_.fewest_sightings &&
           to_seconds(stamp - track.sightings.front().stamp) > options_.history_s)
      track.sightings.pop_front();
    followed_.push_back(std::move(track));
  }
  for (Track& track : tracks_) {
    if (const auto mover = moves(track))
      lost_.push_back({*mover, track.high_m, track.sightings.back().stamp});
    spare_.give(std::move(track));
  }
  tracks_.clear();
  std::swap(tracks_, followed_);
  find_movers();
}

void MovingObjects::restore(std::vector<Track> tracks) {
  tracks_ = std::move(tracks);
  find_movers();
}

std::optional<Mover<Odom>> MovingObjects::moves(const Track& track) const {
  if (static_cast<int>(track.sightings.size()) < options_.fewest_sightings) return std::nullopt;
  const Mover<Odom> mover = track.mover();
  const double speed = std::hypot(mover.vx_mps, mover.vy_mps);
  if (speed < options_.slowest_mps || speed > options_.fastest_mps) return std::nullopt;
  return mover;
}

void MovingObjects::find_movers() {
  movers_.clear();
  for (const Track& track : tracks_)
    if (const auto mover = moves(track)) movers_.push_back(*mover);
}

MovingObjects::Track MovingObjects::Spare::take() {
  if (tracks_.empty()) return {};
  Track track = std::move(tracks_.back());
  tracks_.pop_back();
  track.sightings.clear();
  track.high_m = 0.0;
  return track;
}

namespace {

/// When the vehicle is there if it gains speed at once.
double earliest_s(double along_m, double speed_mps, const MoverOptions& options) {
  const double gain = options.gain_mps2;
  const double top_mps = std::max(speed_mps, options.top_speed_mps);
  const double gaining_m = (top_mps * top_mps - speed_mps * speed_mps) / (2.0 * gain);
  if (along_m <= gaining_m)
    return (std::sqrt(speed_mps * speed_mps + 2.0 * gain * along_m) - speed_mps) / gain;
  return (top_mps - speed_mps) / gain + (along_m - gaining_m) / top_mps;
}

/// ... and if it keeps its speed; a standing one is judged by what it would do.
double latest_s(double along_m, double speed_mps) {
  constexpr double kSlowestMps = 0.3;
  return along_m / std::max(speed_mps, kSlowestMps);
}

/// Where a mover meets the vehicle at a pose between two moments; all around its Base origin while it turns.
std::optional<Point2<Map>> meets(const Mover<Map>& m, const Transform2<Map, Base>& pose, bool turns,
                                 double begin_s, double end_s, const CheckOptions& check,
                                 const MoverOptions& options) {
  constexpr double kTimeStepS = 0.1;
  const double margin_m = m.radius_m + options.margin_m;
  const VehicleOutline zone = check.vehicle.grown(margin_m, margin_m);
  const double circle_m = check.vehicle.reach_m() + margin_m;
  const auto base_from_map = pose.inverse();
  for (int step = 0; begin_s + step * kTimeStepS <= end_s; ++step) {
    const double t = begin_s + step * kTimeStepS;
    const Point2<Map> then{m.at.x_m + m.vx_mps * t, m.at.y_m + m.vy_mps * t};
    const Point2<Base> seen = base_from_map * then;
    if (turns ? std::hypot(seen.x_m, seen.y_m) <= circle_m : zone.contains(seen)) return then;
  }
  return std::nullopt;
}

}  // namespace

PathCheck check_movers(const Path& path, std::size_t from, double ahead_m, double speed_mps,
                       const std::vector<Mover<Map>>& movers, const CheckOptions& check,
                       const MoverOptions& options) {
  PathCheck result;
  const double pace_mps = std::abs(speed_mps);  // strokes are driven backward, too
  double along_m = 0.0;
  double checked_m = -check.step_m;
  for (std::size_t i = from; i < path.points.size() && along_m <= ahead_m && !movers.empty(); ++i) {
    const double step_m =
        i > 0 ? distance_m(path.points[i - 1].position, path.points[i].position) : check.step_m;
    if (i > from) along_m += step_m;
    const bool turns = step_m < kSamePointM;
    if (along_m < checked_m + check.step_m && i != from && !turns) continue;
    const double previous_m = std::max(0.0, checked_m);
    checked_m = along_m;
    const PathPoint& point = path.points[i];
    const Transform2<Map, Base> pose(point.position.x_m, point.position.y_m, point.facing_rad());
    const double begin_s = std::max(0.0, earliest_s(along_m, pace_mps, options) - options.window_s);
    const double end_s = std::min(options.foresight_s, latest_s(along_m, pace_mps) + options.window_s);
    for (const Mover<Map>& m : movers) {
      const auto where = meets(m, pose, turns, begin_s, end_s, check, options);
      if (!where) continue;
      result.free_m = result.care_m = previous_m;
      result.first_blocked = result.last_blocked = i;
      result.where = *where;
      return result;
    }
  }
  return result;
}

bool turn_meets(const Transform2<Map, Base>& pose, const std::vector<Mover<Map>>& movers,
                const CheckOptions& check, const MoverOptions& options) {
  return std::any_of(movers.begin(), movers.end(), [&](const Mover<Map>& m) {
    return meets(m, pose, true, 0.0, options.turn_s, check, options).has_value();
  });
}

}  // namespace madori::planning
