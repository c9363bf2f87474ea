#include "planning/obstacle_check/moving_objects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace madori::planning {
namespace {

struct Group {
  Point2<Odom> centre;
  double radius_m = 0.0;
};

/// Groups of columns that came where nothing was, and touch, with a gap of one cell allowed; by flooding over
/// a grid of the cells between the outermost columns. What a person stands beside is no part of the group.
class Grouping {
 public:
  Grouping(const std::vector<Column>& columns, Stamp stamp)
      : columns_(columns), taken_(columns.size(), false) {
    if (columns.empty()) return;
    x0_ = x1_ = columns.front().cell_x;
    for (const Column& c : columns) {
      x0_ = std::min(x0_, c.cell_x);
      x1_ = std::max(x1_, c.cell_x);
    }
    y0_ = columns.front().cell_y;  // they are sorted by rows
    y1_ = columns.back().cell_y;
    const auto rows = static_cast<std::size_t>(y1_ - y0_) + 1;
    slots_.assign(rows * (static_cast<std::size_t>(x1_ - x0_) + 1), -1);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      taken_[i] = !(columns[i].confirmed && columns[i].entered && columns[i].seen == stamp);
      slots_[slot(columns[i].cell_x, columns[i].cell_y)] = static_cast<std::int32_t>(i);
    }
  }

  std::vector<Group> groups(double widest_m) {
    std::vector<Group> found;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (taken_[i]) continue;
      const auto members = flood(i);
      if (const auto group = compact(members, widest_m)) found.push_back(*group);
    }
    return found;
  }

 private:
  std::vector<std::size_t> flood(std::size_t first) {
    std::vector<std::size_t> members{first};
    taken_[first] = true;
    for (std::size_t next = 0; next < members.size(); ++next) {
      const Column& column = columns_[members[next]];
      for (std::int32_t dy = -2; dy <= 2; ++dy)
        for (std::int32_t dx = -2; dx <= 2; ++dx) take(column.cell_x + dx, column.cell_y + dy, members);
    }
    return members;
  }
  void take(std::int32_t x, std::int32_t y, std::vector<std::size_t>& members) {
    if (x < x0_ || x > x1_ || y < y0_ || y > y1_) return;
    const std::int32_t found = slots_[slot(x, y)];
    if (found < 0) return;
    const auto index = static_cast<std::size_t>(found);
    if (taken_[index]) return;
    taken_[index] = true;
    members.push_back(index);
  }
  [[nodiscard]] std::size_t slot(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y - y0_) * static_cast<std::size_t>(x1_ - x0_ + 1) +
           static_cast<std::size_t>(x - x0_);
  }
  [[nodiscard]] std::optional<Group> compact(const std::vector<std::size_t>& members, double widest_m) const {
    Column box = columns_[members.front()];
    for (const std::size_t i : members) {
      box.min_x_m = std::min(box.min_x_m, columns_[i].min_x_m);
      box.max_x_m = std::max(box.max_x_m, columns_[i].max_x_m);
      box.min_y_m = std::min(box.min_y_m, columns_[i].min_y_m);
      box.max_y_m = std::max(box.max_y_m, columns_[i].max_y_m);
    }
    const double width_m =
        static_cast<double>(std::max(box.max_x_m - box.min_x_m, box.max_y_m - box.min_y_m));
    if (width_m > widest_m) return std::nullopt;
    return Group{{0.5 * static_cast<double>(box.min_x_m + box.max_x_m),
                  0.5 * static_cast<double>(box.min_y_m + box.max_y_m)},
                 std::max(0.1, width_m / 2.0)};
  }

  const std::vector<Column>& columns_;
  std::vector<bool> taken_;
  std::int32_t x0_ = 0, x1_ = 0, y0_ = 0, y1_ = 0;  ///< the outermost cells
  std::vector<std::int32_t> slots_;                 ///< column of each cell, -1 where there is none
};

}  // namespace

Mover<Odom> MovingObjects::Track::mover() const {
  const Sighting& a = sightings.front();
  const Sighting& b = sightings.back();
  const double time_s = to_seconds(b.stamp - a.stamp);
  if (!(time_s > 0.0)) return {b.at, 0.0, 0.0, radius_m};
  return {b.at, (b.at.x_m - a.at.x_m) / time_s, (b.at.y_m - a.at.y_m) / time_s, radius_m};
}

void MovingObjects::update(const std::vector<Column>& columns, Stamp stamp) {
  std::vector<Track> followed;
  for (const Group& group : Grouping(columns, stamp).groups(options_.widest_m)) {
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
    Track track;
    if (best != nullptr) std::swap(track, *best);
    track.sightings.push_back({stamp, group.centre});
    track.radius_m = group.radius_m;
    while (to_seconds(stamp - track.sightings.front().stamp) > options_.history_s)
      track.sightings.pop_front();
    followed.push_back(std::move(track));
  }
  tracks_ = std::move(followed);
}

std::vector<Mover<Odom>> MovingObjects::movers() const {
  std::vector<Mover<Odom>> found;
  for (const Track& track : tracks_) {
    if (static_cast<int>(track.sightings.size()) < options_.fewest_sightings) continue;
    const Mover<Odom> mover = track.mover();
    const double speed = std::hypot(mover.vx_mps, mover.vy_mps);
    if (speed >= options_.slowest_mps && speed <= options_.fastest_mps) found.push_back(mover);
  }
  return found;
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
  constexpr double kSamePointM = 1e-6;
  PathCheck result;
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
    const double begin_s = std::max(0.0, earliest_s(along_m, speed_mps, options) - options.window_s);
    const double end_s = std::min(options.foresight_s, latest_s(along_m, speed_mps) + options.window_s);
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
