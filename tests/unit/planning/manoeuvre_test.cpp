#include "planning/detour/manoeuvre.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/angle.hpp"
#include "planning/detour/detour_planner.hpp"
#include "planning/waypoints/waypoints.hpp"

namespace madori::planning {
namespace {

using Pose = Transform2<Map, Base>;

const CheckOptions kCheck;

/// Points along both walls of a corridor in x, closed at x = -2, `width_m` wide.
std::vector<Point2<Map>> corridor(double width_m) {
  std::vector<Point2<Map>> points;
  for (double x = -2.0; x <= 8.0; x += 0.05)
    for (const double side : {0.5, -0.5}) points.push_back({x, side * width_m});
  for (double y = -0.5 * width_m; y <= 0.5 * width_m; y += 0.05) points.push_back({-2.0, y});
  return points;
}

/// The vehicle driven along the path, every centimetre and degree: how near its outline comes to anything.
double clearance_m(const Path& path, const std::vector<Point2<Map>>& points) {
  double least = 10.0;
  const auto look = [&](const Pose& pose) {
    const auto base_from_map = pose.inverse();
    for (const auto& p : points) {
      const Point2<Base> q = base_from_map * p;
      const double dx = std::max({q.x_m - kCheck.vehicle.front_m, -kCheck.vehicle.rear_m - q.x_m, 0.0});
      const double dy = std::max(std::abs(q.y_m) - kCheck.vehicle.half_width_m, 0.0);
      least = std::min(least, std::hypot(dx, dy));
    }
  };
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const PathPoint& a = path.points[i - 1];
    const PathPoint& b = path.points[i];
    const double turn = wrap_angle(b.facing_rad() - a.facing_rad());
    const int steps = 1 + static_cast<int>(std::max(distance_m(a.position, b.position) / 0.01,
                                                    std::abs(turn) / to_rad(1.0)));
    for (int k = 0; k <= steps; ++k) {
      const double s = static_cast<double>(k) / steps;
      look({a.position.x_m + s * (b.position.x_m - a.position.x_m),
            a.position.y_m + s * (b.position.y_m - a.position.y_m), a.facing_rad() + s * turn});
    }
  }
  return least;
}

TEST(Manoeuvre, TurnsRoundWhereTheVehicleStandsTooNearToAWallToTurnOnTheSpot) {
  const auto points = corridor(2.0);
  for (const double off_m : {-0.2, -0.1, 0.1, 0.2}) {
    const Pose start(2.0, off_m, 0.0);
    const auto found = find_manoeuvre(start, {{{0.5, 0.0, kPi}, 0.0}}, points, {}, kCheck);
    ASSERT_TRUE(found) << off_m << ": " << found.reason();
    const Path& path = found.value().path;
    EXPECT_GT(clearance_m(path, points), 0.03) << off_m;
    EXPECT_LT(distance_m(path.points.back().position, Point2<Map>{0.5, 0.0}), 0.08);
    EXPECT_NEAR(std::abs(wrap_angle(path.points.back().facing_rad() - kPi)), 0.0, to_rad(8.0));
    EXPECT_EQ(path.points.front().position, start.translation());
  }
}

TEST(Manoeuvre, EachStrokeKeepsItsDirection) {
  const auto points = corridor(2.0);
  const auto found = find_manoeuvre({2.0, 0.15, 0.0}, {{{0.5, 0.0, kPi}, 0.0}}, points, {}, kCheck);
  ASSERT_TRUE(found);
  const auto& path = found.value().path.points;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double dx = path[i].position.x_m - path[i - 1].position.x_m;
    const double dy = path[i].position.y_m - path[i - 1].position.y_m;
    if (std::hypot(dx, dy) < 1e-6) continue;
    EXPECT_EQ(path[i].reverse, path[i - 1].reverse) << i << ": a change repeats its place";
    const double along = dx * std::cos(path[i].facing_rad()) + dy * std::sin(path[i].facing_rad());
    EXPECT_EQ(along < 0.0, path[i].reverse) << i;
  }
}

TEST(Manoeuvre, WhereNothingLeadsOutItSaysSo) {
  std::vector<Point2<Map>> box;
  for (double s = -1.1; s <= 1.1; s += 0.05)
    for (const double side : {1.1, -1.1}) box.push_back({s, side}), box.push_back({side, s});
  const auto found = find_manoeuvre({0.0, 0.0, 0.0}, {{{3.0, 0.0, 0.0}, 0.0}}, box, {}, kCheck);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.reason(), "no manoeuvre leads out of here");
}

TEST(Manoeuvre, IsTheLastResortOfADetour) {
  const auto points = corridor(2.0);
  const Path back = make_waypoints({{{2.0, 0.15}}, {{-0.5, 0.15}}}).value();
  DetourRequest request{3, back, 0, {2.0, 0.15, 0.0}, {}, points};
  request.check.first_blocked = request.check.last_blocked = 0;
  request.turn_free = false;
  DetourOptions options;
  options.free_space.max_checks = 20'000;
  const auto answer = plan_detour(request, kCheck, options);
  ASSERT_TRUE(answer.path) << answer.reason;
  EXPECT_GT(clearance_m(*answer.path, points), 0.03);
  EXPECT_EQ(answer.path->points.back().position, back.points.back().position);
}

/// Each look shows an edge a little elsewhere: a way along the very margins is refused in the next one.
TEST(Manoeuvre, KeepsRoomForTheNextLookWhereThereIsRoom) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off_m(-0.03, 0.03);
  int found = 0, refused = 0;
  for (const double y : {-0.25, -0.15, -0.05, 0.05, 0.15, 0.25}) {
    const auto points = corridor(2.3);
    const Path back = make_waypoints({{{2.0, y}}, {{-0.5, y}}}).value();
    DetourRequest request{3, back, 0, {2.0, y, 0.0}, {}, points};
    request.check.first_blocked = request.check.last_blocked = 0;
    request.turn_free = false;
    DetourOptions options;
    options.free_space.max_checks = 0;  // what leads out is a manoeuvre
    const auto answer = plan_detour(request, kCheck, options);
    if (!answer.path) continue;
    ++found;
    for (int look = 0; look < 10; ++look) {
      auto seen = points;
      for (auto& p : seen) p.x_m += off_m(random), p.y_m += off_m(random);
      refused += check_path(*answer.path, 0, 100.0, seen, {}, kCheck).blocked() ? 1 : 0;
    }
  }
  EXPECT_EQ(found, 6);
  EXPECT_EQ(refused, 0);
}

/// Else the cycle refuses what the search finds, which then finds the same again.
TEST(Manoeuvre, WhatIsFoundPassesTheCheckOfTheWay) {
  std::mt19937 random(15);
  const auto between = [&](double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0.0, 1.0)(random);
  };
  int found = 0;
  for (int round = 0; round < 60; ++round) {
    const auto points = corridor(between(1.75, 2.25));
    const double x = between(1.5, 2.5), y = between(-0.3, 0.3), yaw = between(-0.3, 0.3);
    const Pose start(x, y, yaw);
    const double goal_x = between(0.5, 1.5), goal_y = between(-0.1, 0.1), goal_yaw = kPi + between(-0.2, 0.2);
    const Pose goal(goal_x, goal_y, goal_yaw);
    if (!is_free(start, points, {}, kCheck) || !is_free(goal, points, {}, kCheck)) continue;
    const auto way = find_manoeuvre(start, {{goal, 0.0}}, points, {}, kCheck);
    if (!way) continue;
    ++found;
    Path path = way.value().path;
    path.points.push_back(path.points.back());  // the last degrees, on the spot
    path.points.back().heading_rad = goal.yaw_rad();
    path.points.back().reverse = false;
    EXPECT_FALSE(check_path(path, 0, 100.0, points, {}, kCheck).blocked()) << round;
  }
  EXPECT_GT(found, 40);
}

}  // namespace
}  // namespace madori::planning
