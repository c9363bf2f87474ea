#include "planning/obstacle_check/motion_guard.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace madori::planning {
namespace {

/// The pose after driving at constant speeds.
Transform2<Map, Base> moved(const Transform2<Map, Base>& pose, const VelocityCommand& v, double time_s) {
  const double half_turn = 0.5 * v.angular_radps * time_s;
  const double way_m = v.linear_mps * time_s;
  const double chord_m = std::abs(half_turn) < 1e-9 ? way_m : way_m * std::sin(half_turn) / half_turn;
  return pose * Transform2<Base, Base>(chord_m * std::cos(half_turn), chord_m * std::sin(half_turn),
                                       2.0 * half_turn);
}

bool meets_body(const Transform2<Map, Base>& pose, const std::vector<Point2<Map>>& near,
                const VehicleOutline& outline) {
  const auto base_from_map = pose.inverse();
  return std::any_of(near.begin(), near.end(),
                     [&](const Point2<Map>& point) { return outline.contains(base_from_map * point); });
}

bool meets_wall(const Transform2<Map, Base>& pose, const WallGrid& walls, const VehicleOutline& outline) {
  const auto base_from_map = pose.inverse();
  return walls.any_near(pose.translation(), outline.reach_m(),
                        [&](const Segment2<Map>& wall) { return outline.touches(base_from_map * wall); });
}

/// The outline with the widest margin in which nothing stands now; further in than by noise, none at all.
template <class Meets>
const VehicleOutline* clear_outline(const std::array<VehicleOutline, 5>& outlines, Meets&& meets) {
  for (const VehicleOutline& outline : outlines)
    if (!meets(outline)) return &outline;
  return nullptr;
}

std::array<VehicleOutline, 5> outlines_of(const VehicleOutline& vehicle, double margin_m) {
  const auto grown = [&](double by_m) { return vehicle.grown(by_m, by_m); };
  return {grown(margin_m), grown(0.5 * margin_m), grown(0.0), grown(-0.03), grown(-0.06)};
}

}  // namespace

double guarded_share(const Transform2<Map, Base>& pose, const VelocityCommand& v,
                     const std::vector<Point2<Map>>& obstacles, const WallGrid& walls,
                     const VehicleOutline& vehicle, const BrakingModel& braking,
                     const GuardOptions& options) {
  const double reach_m = vehicle.grown(options.body_margin_m, options.body_margin_m).reach_m();
  const double corner_mps = std::abs(v.linear_mps) + std::abs(v.angular_radps) * reach_m;
  if (!(corner_mps > 0.0)) return 1.0;
  const double lost_s = braking.reaction_s + braking.scan_period_s;
  // Half the time that braking takes: the way of braking is driven at half the speed.
  const double braking_s = 0.5 * std::max(std::abs(v.linear_mps) / braking.deceleration_mps2,
                                          std::abs(v.angular_radps) / options.turn_deceleration_radps2);
  const double needed_s = lost_s + braking_s;
  std::vector<Point2<Map>> near;
  const double furthest_m = reach_m + std::abs(v.linear_mps) * needed_s;
  for (const Point2<Map>& point : obstacles)
    if (distance_m(point, pose.translation()) <= furthest_m) near.push_back(point);
  const auto for_bodies = outlines_of(vehicle, options.body_margin_m);
  const auto for_walls = outlines_of(vehicle, options.wall_margin_m);
  const auto* body = clear_outline(for_bodies, [&](const auto& o) { return meets_body(pose, near, o); });
  const auto* wall = clear_outline(for_walls, [&](const auto& o) { return meets_wall(pose, walls, o); });
  const int steps = static_cast<int>(std::ceil(corner_mps * needed_s / options.step_m));
  for (int i = 1; i <= steps; ++i) {
    const auto there = moved(pose, v, needed_s * i / steps);
    const bool free = !(body != nullptr && meets_body(there, near, *body)) &&
                      !(wall != nullptr && meets_wall(there, walls, *wall));
    if (free) continue;
    // share^2 * braking_s + share * lost_s = time to contact, at the full speeds
    const double contact_s = needed_s * (i - 1) / steps;
    const double root = std::sqrt(lost_s * lost_s + 4.0 * braking_s * contact_s);
    return std::clamp((root - lost_s) / (2.0 * braking_s), 0.0, 1.0);
  }
  return 1.0;
}

}  // namespace madori::planning
