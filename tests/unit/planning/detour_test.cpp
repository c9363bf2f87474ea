#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "core/angle.hpp"
#include "planning/detour/detour_planner.hpp"
#include "planning/waypoints/waypoints.hpp"
#include "tests/support/straight_way.hpp"

namespace madori::planning {
namespace {

using test::straight_way;

const CheckOptions kDetourCheck;

/// A row of points across the way.
std::vector<Point2<Map>> row(double x_m, double low_m, double high_m) {
  std::vector<Point2<Map>> points;
  for (double y = low_m; y <= high_m; y += 0.05) points.push_back({x_m, y});
  return points;
}

DetourRequest request_for(const Path& path, const std::vector<Point2<Map>>& obstacles,
                          const WallGrid& walls) {
  return {7, path, 0, {}, check_path(path, 0, 8.0, obstacles, walls, kDetourCheck), obstacles};
}

TEST(SideDetour, GoesAroundAPalletAndComesBack) {
  const Path path = straight_way(14);
  const auto obstacles = row(6.0, -0.4, 0.4);
  const WallGrid walls;
  const auto detour = side_detour(path, 0, check_path(path, 0, 8.0, obstacles, walls, kDetourCheck),
                                  obstacles, walls, kDetourCheck);
  ASSERT_TRUE(detour);
  EXPECT_FALSE(check_path(detour.value().path, 0, 20.0, obstacles, walls, kDetourCheck).blocked());
  EXPECT_NEAR(std::abs(detour.value().offset_m), 0.9, 0.21);
  EXPECT_EQ(detour.value().path.points.back().position, path.points.back().position);
  for (const auto& point : detour.value().path.points) EXPECT_LT(std::abs(point.curvature_per_m), 1.5);
}

TEST(SideDetour, TakesTheOpenSide) {
  const Path path = straight_way(14);
  const auto obstacles = row(6.0, -3.0, 0.2);
  const WallGrid walls;
  const auto check = check_path(path, 0, 8.0, obstacles, walls, kDetourCheck);
  EXPECT_GT(side_detour(path, 0, check, obstacles, walls, kDetourCheck).value().offset_m, 0.0);
  const WallGrid left(std::vector<Segment2<Map>>{{{0.0, 0.6}, {14.0, 0.6}}});
  EXPECT_FALSE(side_detour(path, 0, check, obstacles, left, kDetourCheck)) << "a drawn wall on the open side";
}

/// Inside a bend an offset beyond its radius would fold back on itself: whatever is offered can be followed.
TEST(SideDetour, OffersNothingInABendThatCannotBeFollowed) {
  const Path path = make_waypoints({{{0, 0}}, {{6, 0}}, {{6, 12}}}).value();
  const WallGrid walls;
  const SideDetourOptions options;
  int offered = 0;
  for (double x = 4.6; x < 7.0; x += 0.1) {
    for (double y = -0.6; y < 2.4; y += 0.2) {
      const std::vector<Point2<Map>> obstacles{{x, y}, {x + 0.1, y}, {x, y + 0.1}};
      const auto check = check_path(path, 0, 12.0, obstacles, walls, kDetourCheck);
      if (!check.blocked()) continue;
      const auto detour = side_detour(path, 0, check, obstacles, walls, kDetourCheck, options);
      if (!detour) continue;
      ++offered;
      const auto& points = detour.value().path.points;
      for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        const Point2<Map>& a = points[i - 1].position;
        const Point2<Map>& b = points[i].position;
        const Point2<Map>& c = points[i + 1].position;
        const double turn =
            wrap_angle(std::atan2(c.y_m - b.y_m, c.x_m - b.x_m) - std::atan2(b.y_m - a.y_m, b.x_m - a.x_m));
        ASSERT_LE(std::abs(turn) * options.min_radius_m, 0.5 * (distance_m(a, b) + distance_m(b, c)) + 1e-9)
            << "body at " << x << ", " << y << ", point " << i;
      }
    }
  }
  EXPECT_GT(offered, 100);
}

TEST(SideDetour, NeedsRoomToComeBack) {
  const Path path = straight_way(7);
  const auto obstacles = row(6.0, -0.2, 0.2);
  const WallGrid walls;
  EXPECT_FALSE(side_detour(path, 0, check_path(path, 0, 8.0, obstacles, walls, kDetourCheck), obstacles,
                           walls, kDetourCheck));
}

TEST(FreeSpace, FindsAWayAroundALongBarrierAndTheSameOneForASeed) {
  const Path path = straight_way(16);
  const auto obstacles = row(6.0, -2.6, 2.6);
  const WallGrid walls;
  DetourOptions options;
  options.side.furthest_m = 1.0;
  options.free_space.max_checks = 200'000;
  const auto answer = plan_detour(request_for(path, obstacles, walls), kDetourCheck, options);
  ASSERT_TRUE(answer.path.has_value()) << answer.reason;
  EXPECT_EQ(answer.id, 7U);
  EXPECT_FALSE(check_path(*answer.path, 0, 40.0, obstacles, walls, kDetourCheck).blocked());
  EXPECT_EQ(answer.path->points.back().position, path.points.back().position);
}

/// Random trees wander; what is driven does not. The oracle is the shortest way around the barrier's end.
TEST(FreeSpace, WaysAreNotMuchLongerThanNeeded) {
  const auto obstacles = row(4.0, -2.6, 1.0);
  const WallGrid walls;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    FreeSpaceOptions options;
    options.max_checks = 200'000;
    options.seed = seed;
    const auto path = free_space_path({}, {8.0, 0.0, 0.0}, obstacles, walls, kDetourCheck, options);
    ASSERT_TRUE(path) << path.reason();
    double length_m = 0.0;
    const auto& points = path.value().points;
    for (std::size_t i = 1; i < points.size(); ++i)
      length_m += distance_m(points[i - 1].position, points[i].position);
    EXPECT_LT(length_m, 1.35 * 2.0 * std::hypot(4.0, 1.4)) << "seed " << seed;
    EXPECT_FALSE(check_path(path.value(), 0, 40.0, obstacles, walls, kDetourCheck).blocked())
        << "seed " << seed;
  }
}

TEST(FreeSpace, AClosedRoomHasNoWayAndTheSearchEnds) {
  const WallGrid walls(std::vector<Segment2<Map>>{
      {{-3, -3}, {5, -3}}, {{5, -3}, {5, 3}}, {{5, 3}, {-3, 3}}, {{-3, 3}, {-3, -3}}});
  FreeSpaceOptions options;
  options.max_checks = 20'000;
  const auto path = free_space_path({}, {8.0, 0.0, 0.0}, {}, walls, kDetourCheck, options);
  ASSERT_FALSE(path);
  EXPECT_EQ(path.reason(), "no free way was found within the time allowed");
}

TEST(DetourPlanner, AnswersFromItsOwnThread) {
  const Path path = straight_way(14);
  const auto obstacles = row(6.0, -0.4, 0.4);
  DetourPlanner planner(kDetourCheck, {});
  EXPECT_FALSE(planner.take());
  planner.submit(request_for(path, obstacles, WallGrid()));
  std::optional<DetourAnswer> answer;
  for (int i = 0; i < 1000 && !answer; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    answer = planner.take();
  }
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->path.has_value());
}

TEST(Detour, AWayThatComesBackToAStrokeBackwardBeginsAStrokeThere) {
  Path route = straight_way(6);
  for (int i = 0; i <= 60; ++i)
    route.points.push_back({{6.0 - 0.1 * i, 0.0}, kPi, 0.0, 0.15, true});  // and back, looking ahead
  std::vector<Point2<Map>> bodies;
  for (double y = -2.3; y <= 0.35; y += 0.05) bodies.push_back({4.0, y});
  DetourRequest request{7, route, 0, {}, {}, bodies};
  request.check.first_blocked = 25;
  request.check.last_blocked = 70;  // on the way back
  request.check.free_m = 2.5;
  request.turn_free = false;
  const auto answer = plan_detour(request, kDetourCheck, {});
  ASSERT_TRUE(answer.path) << answer.reason;
  const auto& points = answer.path->points;
  int changes = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].reverse == points[i - 1].reverse) continue;
    ++changes;
    EXPECT_LT(distance_m(points[i].position, points[i - 1].position), kSamePointM) << i;
  }
  EXPECT_GT(changes, 0);
}

}  // namespace
}  // namespace madori::planning
