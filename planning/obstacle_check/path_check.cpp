#include "planning/obstacle_check/path_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/angle.hpp"
#include "core/segment_distance.hpp"
#include "planning/obstacle_check/clearance.hpp"
#include "planning/waypoints/waypoints.hpp"

namespace madori::planning {
namespace {

/// What one placement of the vehicle meets.
struct Contact {
  Point2<Map> where;
  bool by_wall = false;
};

/// What a scanner's protective field covers, from the vehicle's front on; nothing where there is none.
std::optional<VehicleOutline> field_of(const CheckOptions& o) {
  if (!(o.protective.ahead_m > 0.0)) return std::nullopt;
  const VehicleOutline& v = o.vehicle;
  return VehicleOutline{v.front_m + o.protective.ahead_m + o.field_margin_m, -v.front_m,
                        v.half_width_m + o.protective.beside_m + o.field_margin_m, v.height_m};
}

/// A vehicle's outline with margins, the published cylinder, and the protective field.
struct Zone {
  VehicleOutline outline;
  std::optional<VehicleOutline> field;
  double radius_m;

  Zone(const CheckOptions& o, double ends_m, double sides_m)
      : outline(o.vehicle.grown(ends_m, sides_m)),
        field(field_of(o)),
        radius_m(o.vehicle.half_width_m + sides_m) {}
  [[nodiscard]] double reach_m() const {
    return std::max({outline.reach_m(), radius_m, field ? field->reach_m() : 0.0});
  }
  [[nodiscard]] bool holds(const Point2<Base>& p) const {
    return outline.contains(p) || in_circle(p) || (field && field->contains(p));
  }
  [[nodiscard]] bool in_circle(const Point2<Base>& p) const {
    return p.x_m * p.x_m + p.y_m * p.y_m <= radius_m * radius_m;
  }
};

/// What is kept free where the vehicle drives no faster than this: at its ends what it would drive before
/// braking shows.
Zone stop_zone(const CheckOptions& options, double speed_mps) {
  return {options, ends_margin_m(options, speed_mps), options.sides_margin_m};
}

std::optional<Contact> meets_point(const Transform2<Map, Base>& pose,
                                   const std::vector<Point2<Map>>& obstacles, const Zone& zone) {
  const auto base_from_map = pose.inverse();
  const double square = zone.reach_m() * zone.reach_m();
  for (const Point2<Map>& point : obstacles) {
    const double dx = point.x_m - pose.x_m();
    const double dy = point.y_m - pose.y_m();
    if (dx * dx + dy * dy <= square && zone.holds(base_from_map * point)) return Contact{point, false};
  }
  return std::nullopt;
}

std::optional<Contact> meets_wall(const Transform2<Map, Base>& pose, const WallGrid& walls,
                                  const CheckOptions& options) {
  const VehicleOutline outline = options.vehicle.grown(options.wall_margin_m, options.wall_margin_m);
  const auto field = field_of(options);
  const auto base_from_map = pose.inverse();
  std::optional<Contact> contact;
  const double reach_m = std::max(outline.reach_m(), field ? field->reach_m() : 0.0);
  walls.any_near(pose.translation(), reach_m, [&](const Segment2<Map>& wall) {
    const Segment2<Base> seen = base_from_map * wall;
    if (!outline.touches(seen) && !(field && field->touches(seen))) return false;
    contact = {nearest_point(wall, pose.translation()), true};
    return true;
  });
  return contact;
}

/// Obstacles that any placement along the checked points could meet.
void find_near(const Path& path, std::size_t from, std::size_t end, const std::vector<Point2<Map>>& obstacles,
               double reach_m, std::vector<Point2<Map>>& near) {
  Point2<Map> low = path.points[from].position;
  Point2<Map> high = low;
  for (std::size_t i = from; i < end; ++i) {
    const Point2<Map>& p = path.points[i].position;
    low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
    high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
  }
  near.clear();
  for (const Point2<Map>& p : obstacles)
    if (p.x_m >= low.x_m - reach_m && p.x_m <= high.x_m + reach_m && p.y_m >= low.y_m - reach_m &&
        p.y_m <= high.y_m + reach_m)
      near.push_back(p);
}

Transform2<Map, Base> placed(const PathPoint& point) {
  return {point.position.x_m, point.position.y_m, point.facing_rad()};
}

/// Between two checked headings the corner of a vehicle that turns on the spot cuts at most half the margin.
double heading_step_rad(const CheckOptions& options) {
  constexpr double kMostRad = 2.0 * kPi / kCheckedHeadings;
  constexpr double kFinest = 32.0;  // of no margin half can be kept
  const double wanted_rad = options.turn_margin_m / options.vehicle.half_width_m;
  return kMostRad / std::clamp(std::ceil(kMostRad / wanted_rad), 1.0, kFinest);
}

/// The placements on the way to another one that turns by so much, the first left out.
template <class Visit>
bool any_between(const Transform2<Map, Base>& from, const Transform2<Map, Base>& to, double turn_rad,
                 double step_rad, Visit&& visit) {
  constexpr double kRounding = 1e-6;
  const int steps = static_cast<int>(std::ceil(std::abs(turn_rad) / step_rad - kRounding));
  for (int k = 1; k < steps; ++k) {
    const double share = static_cast<double>(k) / steps;
    if (visit({from.x_m() + share * (to.x_m() - from.x_m()), from.y_m() + share * (to.y_m() - from.y_m()),
               from.yaw_rad() + share * turn_rad}))
      return true;
  }
  return visit(to);
}

/// Which points of a path are checked: all turns on the spot, and of a way what is not both near to the
/// last one that was, and on a straight with it.
struct Pick {
  const Path& path;
  std::size_t from, end;
  double step_m, step_rad;

  [[nodiscard]] bool turns(std::size_t i) const {
    return i > 0 && distance_m(path.points[i - 1].position, path.points[i].position) < kSamePointM;
  }
  [[nodiscard]] bool skips(std::size_t i, std::size_t checked, double since_m) const {
    if (i == from || i + 1 == end || turns(i) || since_m >= step_m) return false;
    const double turn_rad = path.points[i + 1].facing_rad() - path.points[checked].facing_rad();
    return std::abs(wrap_angle(turn_rad)) <= step_rad;  // else this one lies between
  }
  /// Every placement from the point before on, or all of a turn on the spot that begins there.
  template <class Visit>
  bool any_placement(std::size_t i, Visit&& visit) const {
    constexpr double kEitherWayRad =
        3.0;  // nearly about: noise decides which way it turns, so both must be free
    if (i == 0 || (i == from && !turns(i))) return visit(placed(path.points[i]));
    const auto before = placed(path.points[i - 1]), here = placed(path.points[i]);
    double turn_rad = wrap_angle(here.yaw_rad() - before.yaw_rad());
    if (turns(i) && std::abs(turn_rad) > kEitherWayRad) turn_rad = 2.0 * kPi;
    return any_between(before, here, turn_rad, step_rad, visit);
  }
};

/// From the point before to this one; 0 at the first.
double step_to(const Path& path, std::size_t from, std::size_t i) {
  return i > from ? distance_m(path.points[i - 1].position, path.points[i].position) : 0.0;
}

/// Behind the first point that is farther along than `ahead_m`.
std::size_t end_of_check(const Path& path, std::size_t from, double ahead_m) {
  double along_m = 0.0;
  std::size_t end = from + 1;
  for (; end < path.points.size() && along_m <= ahead_m; ++end) along_m += step_to(path, from, end);
  return end;
}

}  // namespace

PathCheck PathChecker::check(const Path& path, std::size_t from, double ahead_m,
                             const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                             const CheckOptions& options) {
  PathCheck check;
  if (from >= path.points.size()) return check;
  const std::size_t end = end_of_check(path, from, ahead_m);
  const Zone turning(options, options.turn_margin_m, options.turn_margin_m);
  const Zone care(options, options.ends_margin_m + options.care_margin_m,
                  options.sides_margin_m + options.care_margin_m);
  find_near(path, from, end, obstacles, care.reach_m(), near_);
  const Pick pick{path, from, end, options.step_m, heading_step_rad(options)};
  double here_m = 0.0;
  double checked_m = 0.0;
  std::size_t checked = from;
  for (std::size_t i = from; i < end; ++i) {
    here_m += step_to(path, from, i);
    if (pick.skips(i, checked, here_m - checked_m)) continue;
    const double previous_m = std::exchange(checked_m, here_m);
    checked = i;
    const Zone zone = pick.turns(i) ? turning : stop_zone(options, path.points[i].speed_limit_mps);
    std::optional<Contact> contact;
    bool slow = false;
    pick.any_placement(i, [&](const Transform2<Map, Base>& pose) {
      contact = meets_point(pose, near_, zone);
      if (!contact) contact = meets_wall(pose, walls, options);
      slow = slow || contact || meets_point(pose, near_, care);
      return contact.has_value();
    });
    if (slow && check.care_m == PathCheck::kFree) check.care_m = previous_m;
    if (!contact) continue;
    if (!check.blocked()) {
      check.free_m = previous_m;
      check.first_blocked = i;
      check.by_wall = contact->by_wall;
      check.where = contact->where;
    }
    check.last_blocked = i;
  }
  return check;
}

PathCheck check_path(const Path& path, std::size_t from, double ahead_m,
                     const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                     const CheckOptions& options) {
  return PathChecker().check(path, from, ahead_m, obstacles, walls, options);
}

void set_back(std::vector<Point2<Map>>& obstacles, const Transform2<Map, Base>& map_from_base,
              const CheckOptions& options) {
  constexpr double kSeenWithinM = 0.02;  // from look to look
  constexpr double kDeepestM = 0.1;      // of the corner of what stands oblique to the columns
  const Zone zone(options, options.ends_margin_m, options.sides_margin_m);
  const VehicleOutline beyond = zone.outline.grown(kSeenWithinM, kSeenWithinM);
  const auto base_from_map = map_from_base.inverse();
  for (Point2<Map>& obstacle : obstacles) {
    Point2<Base> p = base_from_map * obstacle;
    const bool in_outline = zone.outline.contains(p);
    if (!in_outline && !zone.in_circle(p)) continue;
    if ((zone.field && zone.field->contains(p)) || clearance_m(options.vehicle, p) < -kDeepestM) continue;
    if (in_outline) {
      const double aside_m = std::copysign(beyond.half_width_m, p.y_m);
      const double ahead_m =
          p.x_m - beyond.front_m > -beyond.rear_m - p.x_m ? beyond.front_m : -beyond.rear_m;
      if (std::abs(aside_m - p.y_m) < std::abs(ahead_m - p.x_m))
        p.y_m = aside_m;
      else
        p.x_m = ahead_m;
    }
    const double middle_m = std::hypot(p.x_m, p.y_m);
    const double out = std::max(1.0, (zone.radius_m + kSeenWithinM) / std::max(middle_m, kSeenWithinM));
    obstacle = map_from_base * Point2<Base>{p.x_m * out, p.y_m * out};
  }
}

bool is_free_between(const Transform2<Map, Base>& from, const Transform2<Map, Base>& to,
                     const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                     const CheckOptions& options) {
  return !any_between(
      from, to, wrap_angle(to.yaw_rad() - from.yaw_rad()), heading_step_rad(options),
      [&](const Transform2<Map, Base>& pose) { return !is_free(pose, obstacles, walls, options); });
}

bool is_free(const Transform2<Map, Base>& pose, const std::vector<Point2<Map>>& obstacles,
             const WallGrid& walls, const CheckOptions& options) {
  return !meets_point(pose, obstacles, Zone(options, options.ends_margin_m, options.sides_margin_m)) &&
         !meets_wall(pose, walls, options);
}

}  // namespace madori::planning
