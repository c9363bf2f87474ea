#include "planning/obstacle_check/path_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

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

Transform2<Map, Base> placed(const PathPoint& point, double heading_rad) {
  return {point.position.x_m, point.position.y_m, heading_rad};
}

/// The headings in which the vehicle stands at a point: one, or all of a turn on the spot that begins there.
template <class Visit>
bool any_heading(const Path& path, std::size_t i, double turn_step_rad, Visit&& visit) {
  const PathPoint& point = path.points[i];
  const bool turns = i > 0 && distance_m(path.points[i - 1].position, point.position) < kSamePointM;
  if (!turns) return visit(placed(point, point.facing_rad()));
  const double from_rad = path.points[i - 1].facing_rad();
  constexpr double kEitherWayRad =
      3.0;  // nearly about: noise decides which way it turns, so both must be free
  double turn = wrap_angle(point.facing_rad() - from_rad);
  if (std::abs(turn) > kEitherWayRad) turn = 2.0 * kPi;
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(turn) / turn_step_rad)));
  for (int k = 1; k <= steps; ++k)
    if (visit(placed(point, from_rad + turn * k / steps))) return true;
  return false;
}

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
  double here_m = 0.0;
  double checked_m = -options.step_m;
  for (std::size_t i = from; i < end; ++i) {
    here_m += step_to(path, from, i);
    const bool turns =
        i > 0 && distance_m(path.points[i - 1].position, path.points[i].position) < kSamePointM;
    if (here_m < checked_m + options.step_m && !turns && i + 1 != end) continue;
    const double previous_m = std::max(0.0, checked_m);
    checked_m = here_m;
    std::optional<Contact> contact;
    bool slow = false;
    any_heading(path, i, options.turn_step_rad, [&](const Transform2<Map, Base>& pose) {
      contact =
          meets_point(pose, near_, turns ? turning : stop_zone(options, path.points[i].speed_limit_mps));
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

bool is_free(const Transform2<Map, Base>& pose, const std::vector<Point2<Map>>& obstacles,
             const WallGrid& walls, const CheckOptions& options) {
  return !meets_point(pose, obstacles, Zone(options, options.ends_margin_m, options.sides_margin_m)) &&
         !meets_wall(pose, walls, options);
}

}  // namespace madori::planning
