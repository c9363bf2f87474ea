#include "planning/obstacle_check/motion_guard.hpp"

#include <algorithm>
#include <cmath>

#include "planning/obstacle_check/clearance.hpp"

namespace madori::planning {
namespace {

/// A vehicle that goes on at constant speeds, in its own axes at the start.
struct Motion {
  VelocityCommand v;
  double corner_mps;  ///< no point of the outline is faster
  double until_s;     ///< it could stand by then

  [[nodiscard]] Transform2<Base, Base> at(double time_s) const {
    const double half_turn = 0.5 * v.angular_radps * time_s;
    const double way_m = v.linear_mps * time_s;
    const double chord_m = std::abs(half_turn) < 1e-9 ? way_m : way_m * std::sin(half_turn) / half_turn;
    return {chord_m * std::cos(half_turn), chord_m * std::sin(half_turn), 2.0 * half_turn};
  }
};

/// What must be left to an obstacle that is so far away now: the margin; half, where the vehicle stands
/// within it; nothing less, where it is inside.
double least_clearance_m(double now_m, double margin_m) {
  if (now_m >= margin_m) return margin_m;
  return now_m > 0.0 ? 0.5 * now_m : now_m;
}

/// Until when the outline keeps its distance. No clearance changes faster than the outline's fastest point
/// moves, so that where there is room the next pose that must be looked at is as far away.
template <class Shape>
double kept_until_s(const Motion& motion, const VehicleOutline& vehicle, const Shape& shape, double margin_m,
                    double step_m) {
  constexpr double kRounding = 1e-9;
  const double least_m = least_clearance_m(clearance_m(vehicle, shape), margin_m) - kRounding;
  double kept_s = 0.0;
  for (double s = 0.0; s < motion.until_s;) {
    const double room_m = clearance_m(vehicle, motion.at(s).inverse() * shape) - least_m;
    if (room_m < 0.0) return kept_s;
    kept_s = s;
    s += std::max(room_m, step_m) / motion.corner_mps;
  }
  return motion.until_s;
}

}  // namespace

double guarded_share(const Transform2<Map, Base>& pose, const VelocityCommand& v,
                     const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                     const VehicleOutline& vehicle, const BrakingModel& braking,
                     const GuardOptions& options) {
  const double reach_m = vehicle.reach_m();
  const double corner_mps = std::abs(v.linear_mps) + std::abs(v.angular_radps) * reach_m;
  if (!(corner_mps > 0.0)) return 1.0;
  const double lost_s = braking.before_braking_s();
  // Half the time that braking takes: the way of braking is driven at half the speed.
  const double braking_s = 0.5 * std::max(std::abs(v.linear_mps) / braking.deceleration_mps2,
                                          std::abs(v.angular_radps) / braking.turn_deceleration_radps2);
  const Motion motion{v, corner_mps, lost_s + braking_s};
  const double furthest_m = reach_m + std::abs(v.linear_mps) * motion.until_s +
                            std::max(options.body_margin_m, options.wall_margin_m);
  const auto base_from_map = pose.inverse();
  double contact_s = motion.until_s;
  for (const Point2<Map>& point : obstacles)
    if (distance_m(point, pose.translation()) <= furthest_m)
      contact_s = std::min(contact_s, kept_until_s(motion, vehicle, base_from_map * point,
                                                   options.body_margin_m, options.step_m));
  walls.any_near(pose.translation(), furthest_m, [&](const Segment2<Map>& wall) {
    contact_s = std::min(contact_s, kept_until_s(motion, vehicle, base_from_map * wall, options.wall_margin_m,
                                                 options.step_m));
    return contact_s <= 0.0;
  });
  if (contact_s >= motion.until_s) return 1.0;
  // share^2 * braking_s + share * lost_s = time to contact, at the full speeds
  const double root = std::sqrt(lost_s * lost_s + 4.0 * braking_s * contact_s);
  return std::clamp((root - lost_s) / (2.0 * braking_s), 0.0, 1.0);
}

}  // namespace madori::planning
