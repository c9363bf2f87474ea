// The clearance law, with a vehicle that brakes as its record says: no obstacle is ever nearer to the outline
// than the law allows, wherever obstacles stand, some of them inside the outline.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "planning/obstacle_check/clearance.hpp"
#include "planning/obstacle_check/motion_guard.hpp"
#include "planning/obstacle_check/path_check.hpp"

namespace madori::planning {
namespace {

double between(double low, double high) {
  return low + (high - low) * *rc::gen::inRange(0, 100'001) / 100'000.0;
}

struct World {
  VehicleOutline vehicle;
  BrakingModel braking;
  GuardOptions guard;
  std::vector<Point2<Map>> bodies;
  std::vector<Segment2<Map>> walls;
  Transform2<Map, Base> pose;
  VelocityCommand asked;
};

/// Somewhere around the vehicle; a third of them within 10 cm of its outline, on either side of it.
Point2<Map> any_place(const World& world) {
  if (*rc::gen::inRange(0, 3) > 0) return world.pose * Point2<Base>{between(-3.0, 3.0), between(-3.0, 3.0)};
  const VehicleOutline edge = world.vehicle.grown(between(-0.1, 0.1), between(-0.1, 0.1));
  if (*rc::gen::arbitrary<bool>())
    return world.pose * Point2<Base>{*rc::gen::arbitrary<bool>() ? edge.front_m : -edge.rear_m,
                                     between(-edge.half_width_m, edge.half_width_m)};
  return world.pose * Point2<Base>{between(-edge.rear_m, edge.front_m),
                                   *rc::gen::arbitrary<bool>() ? edge.half_width_m : -edge.half_width_m};
}

World any_world() {
  World world;
  world.vehicle = {between(0.2, 1.8), between(0.2, 1.2), between(0.2, 0.5), 0.8};
  world.braking = {between(0.3, 2.0), between(0.5, 3.0), between(0.0, 0.4), between(0.02, 0.2)};
  world.pose = {between(-5.0, 5.0), between(-5.0, 5.0), between(-kPi, kPi)};
  world.asked = {between(-1.5, 1.5), between(-1.5, 1.5)};
  for (int i = *rc::gen::inRange(0, 8); i > 0; --i) world.bodies.push_back(any_place(world));
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i)
    world.walls.push_back({any_place(world), any_place(world)});
  return world;
}

/// The same curve, driven on for the time that is lost and then braked: the poses on it.
std::vector<Transform2<Base, Base>> way_to_stand(const World& world, double share) {
  constexpr double kStepS = 0.002;
  double v = share * world.asked.linear_mps, w = share * world.asked.angular_radps;
  const double braking_s = std::max(std::abs(v) / world.braking.deceleration_mps2,
                                    std::abs(w) / world.braking.turn_deceleration_radps2);
  const double lost_s = world.braking.reaction_s + world.braking.scan_period_s;
  std::vector<Transform2<Base, Base>> poses{{}};
  for (double t = 0.0; t < lost_s + braking_s; t += kStepS) {
    const double left = t < lost_s ? 1.0 : 1.0 - (t - lost_s) / braking_s;
    const double turn = left * w * kStepS;
    poses.push_back(poses.back() * Transform2<Base, Base>(left * v * kStepS * std::cos(0.5 * turn),
                                                          left * v * kStepS * std::sin(0.5 * turn), turn));
  }
  return poses;
}

/// Written down on its own, from the header's words.
double least_allowed_m(double now_m, double margin_m) {
  if (now_m <= 0.0) return now_m;
  return now_m < margin_m ? now_m / 2.0 : margin_m;
}

template <class Shape>
void expect_kept(const World& world, const std::vector<Transform2<Base, Base>>& poses, const Shape& shape,
                 double margin_m) {
  constexpr double kResolution = 0.004;  // the guard looks every 5 mm of way
  const auto seen = world.pose.inverse() * shape;
  const double least_m = least_allowed_m(clearance_m(world.vehicle, seen), margin_m);
  for (const auto& pose : poses)
    RC_ASSERT(clearance_m(world.vehicle, pose.inverse() * seen) >= least_m - kResolution);
}

double share_of(const World& world) {
  return guarded_share(world.pose, world.asked, world.bodies, WallGrid(world.walls), world.vehicle,
                       world.braking, world.guard);
}

RC_GTEST_PROP(ClearanceLaw, BrakingEndsBeforeAnyObstacleIsTooNear, ()) {
  const World world = any_world();
  const double share = share_of(world);
  RC_ASSERT(share >= 0.0 && share <= 1.0);
  const auto poses = way_to_stand(world, share);
  for (const auto& body : world.bodies) expect_kept(world, poses, body, world.guard.body_margin_m);
  for (const auto& wall : world.walls) expect_kept(world, poses, wall, world.guard.wall_margin_m);
}

/// The law is no blanket: what stays far from everything is left alone.
RC_GTEST_PROP(ClearanceLaw, ACommandThatKeepsAwayFromEverythingIsLeftAlone, ()) {
  const World world = any_world();
  const auto poses = way_to_stand(world, 1.0);
  constexpr double kClear = 0.03;
  const auto far = [&](const auto& shape) {
    return std::all_of(poses.begin(), poses.end(), [&](const auto& pose) {
      return clearance_m(world.vehicle, pose.inverse() * (world.pose.inverse() * shape)) > kClear;
    });
  };
  RC_PRE(std::all_of(world.bodies.begin(), world.bodies.end(), far));
  RC_PRE(std::all_of(world.walls.begin(), world.walls.end(), far));
  RC_ASSERT(share_of(world) == 1.0);
}

/// Nor is it more than a law: driven a centimetre further on its curve than braking leads, the vehicle would
/// be too near to something.
RC_GTEST_PROP(ClearanceLaw, ASlowedCommandIsAsFastAsTheLawAllows, ()) {
  const World world = any_world();
  const double share = share_of(world);
  if (share >= 1.0) return;
  const auto& [v, w] = world.asked;
  const double braking_s = 0.5 * std::max(std::abs(v) / world.braking.deceleration_mps2,
                                          std::abs(w) / world.braking.turn_deceleration_radps2);
  const double lost_s = world.braking.reaction_s + world.braking.scan_period_s;
  const double corner_mps = std::abs(v) + std::abs(w) * world.vehicle.reach_m();
  const double until_s = share * (share * braking_s + lost_s) + 0.01 / corner_mps;
  double least_room_m = 1e9;
  const auto note = [&](const Transform2<Base, Base>& pose, const auto& shape, double margin_m) {
    const auto seen = world.pose.inverse() * shape;
    const double least_m = least_allowed_m(clearance_m(world.vehicle, seen), margin_m);
    least_room_m = std::min(least_room_m, clearance_m(world.vehicle, pose.inverse() * seen) - least_m);
  };
  constexpr int kParts = 2000;
  Transform2<Base, Base> pose;
  const double step_s = until_s / kParts, turn = w * step_s;
  for (int i = 0; i < kParts; ++i) {
    pose = pose *
           Transform2<Base, Base>(v * step_s * std::cos(0.5 * turn), v * step_s * std::sin(0.5 * turn), turn);
    for (const auto& body : world.bodies) note(pose, body, world.guard.body_margin_m);
    for (const auto& wall : world.walls) note(pose, wall, world.guard.wall_margin_m);
  }
  RC_ASSERT(least_room_m < 0.001);
}

/// An obstacle more takes nothing away from the others: the share can only fall.
RC_GTEST_PROP(ClearanceLaw, AnObstacleMoreNeverSwitchesOffAnother, ()) {
  World world = any_world();
  const double before = share_of(world);
  world.bodies.push_back(any_place(world));
  RC_ASSERT(share_of(world) <= before);
}

RC_GTEST_PROP(ClearanceOfAnOutline, IsTheLeastOverTheSegment, ()) {
  const World world = any_world();
  const auto at = [] { return Point2<Base>{between(-2.5, 2.5), between(-1.5, 1.5)}; };
  const Segment2<Base> s{at(), at()};
  double least = 1e9;
  constexpr int kParts = 2000;
  for (int i = 0; i <= kParts; ++i)
    least =
        std::min(least, clearance_m(world.vehicle, Point2<Base>{s.a.x_m + (s.b.x_m - s.a.x_m) * i / kParts,
                                                                s.a.y_m + (s.b.y_m - s.a.y_m) * i / kParts}));
  const double found = clearance_m(world.vehicle, s);
  RC_ASSERT(found <= least + 1e-9);
  RC_ASSERT(found > least - 0.003);
}

/// What is set back is outside the margins and no nearer than it was, the shortest way out where the outline
/// alone counts; what was outside stays where it was, and so does what is deep inside.
RC_GTEST_PROP(SetBack, AVehicleMayLeaveWhatItStandsAgainst, ()) {
  const World world = any_world();
  CheckOptions options;
  options.vehicle = world.vehicle;
  options = with_margins(options, {between(0.1, 1.0), 0.0});
  std::vector<Point2<Map>> obstacles = world.bodies;
  set_back(obstacles, world.pose, options);
  const auto base_from_map = world.pose.inverse();
  const VehicleOutline& v = world.vehicle;
  const double circle_m = v.half_width_m + options.sides_margin_m - std::min(v.front_m, v.rear_m);
  const double most_m = std::max(std::hypot(options.ends_margin_m, options.sides_margin_m), circle_m);
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const double was_m = clearance_m(world.vehicle, base_from_map * world.bodies[i]);
    const double is_m = clearance_m(world.vehicle, base_from_map * obstacles[i]);
    const bool free = is_free(world.pose, {obstacles[i]}, {}, options);
    RC_ASSERT(free || (was_m < -0.1 && obstacles[i] == world.bodies[i]));
    RC_ASSERT(is_m >= was_m - 1e-9);
    if (was_m > most_m || was_m < -0.1) RC_ASSERT(obstacles[i] == world.bodies[i]);
    const double seen_within_m = 0.02, ends_m = std::min(v.front_m, v.rear_m) + options.ends_margin_m;
    if (obstacles[i] == world.bodies[i] || ends_m < v.half_width_m + options.sides_margin_m) continue;
    const auto beyond =
        v.grown(options.ends_margin_m + seen_within_m, options.sides_margin_m + seen_within_m);
    const double depth_m = -clearance_m(beyond, base_from_map * world.bodies[i]);
    RC_ASSERT(std::abs(distance_m(obstacles[i], world.bodies[i]) - depth_m) < 1e-9);
  }
}

/// A path that is one point long is free where the vehicle may stand there.
RC_GTEST_PROP(CheckPath, OfOnePointIsWhetherTheVehicleIsFreeThere, ()) {
  const World world = any_world();
  CheckOptions options;
  options.vehicle = world.vehicle;
  const WallGrid walls(world.walls);
  const Path path{{{world.pose.translation(), world.pose.yaw_rad(), 0.0}}};
  const PathCheck check = check_path(path, 0, 0.0, world.bodies, walls, options);
  RC_ASSERT(check.blocked() == !is_free(world.pose, world.bodies, walls, options));
  if (check.blocked()) RC_ASSERT(check.free_m == 0.0);
}

/// Whatever is passed in a turn on the spot, begun where nothing is within the margins: never nearer than
/// half of them, at any heading. Both checks of a way see the same.
RC_GTEST_PROP(CheckPath, ATurnOnTheSpotPassesNothingNearerThanHalfTheMargin, ()) {
  World world = any_world();
  CheckOptions options;
  options.vehicle = world.vehicle;
  options.ends_margin_m = options.sides_margin_m = options.turn_margin_m = between(0.02, 0.1);
  std::erase_if(world.bodies, [&](const auto& body) { return !is_free(world.pose, {body}, {}, options); });
  const double turn_rad = between(-2.9, 2.9);
  Path path;
  path.points.assign(2, PathPoint{world.pose.translation(), world.pose.yaw_rad()});
  path.points.back().heading_rad += turn_rad;
  const auto pose_at = [&](double share) {
    return world.pose * Transform2<Base, Base>(0.0, 0.0, share * turn_rad);
  };
  const bool blocked = check_path(path, 1, 0.0, world.bodies, {}, options).blocked();
  RC_ASSERT(blocked == !is_free_between(world.pose, pose_at(1.0), world.bodies, {}, options));
  if (blocked) return;
  constexpr int kParts = 500;
  for (int i = 0; i <= kParts; ++i) {
    const auto base_from_map = pose_at(static_cast<double>(i) / kParts).inverse();
    for (const auto& body : world.bodies)
      RC_ASSERT(clearance_m(world.vehicle, base_from_map * body) > 0.45 * options.turn_margin_m);
  }
}

}  // namespace
}  // namespace madori::planning
