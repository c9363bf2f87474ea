#include "planning/waypoints/waypoints.hpp"

#include <gtest/gtest.h>

#include "core/angle.hpp"

namespace madori::planning {
namespace {

std::vector<WayCorner> corners(std::initializer_list<Point2<Map>> points) {
  std::vector<WayCorner> way;
  for (const auto& point : points) way.push_back({point});
  return way;
}

TEST(Waypoints, AStraightLegHasEqualSpacingAndMeetsItsEnds) {
  const auto path = make_waypoints(corners({{1, 1}, {1, 3.04}})).value();
  ASSERT_EQ(path.points.size(), 21U);
  EXPECT_EQ(path.points.front().position, (Point2<Map>{1, 1}));
  EXPECT_NEAR(path.points.back().position.y_m, 3.04, 1e-12);
  for (std::size_t i = 1; i < path.points.size(); ++i)
    EXPECT_NEAR(distance_m(path.points[i - 1].position, path.points[i].position), 0.102, 1e-9);
}

TEST(Waypoints, ARightAngleIsRoundedWithoutLeavingTheCornerFar) {
  WaypointOptions options;
  const auto path = make_waypoints(corners({{0, 0}, {5, 0}, {5, 5}}), options).value();
  double nearest = 10.0;
  double sharpest = 0.0;
  for (const auto& point : path.points) {
    nearest = std::min(nearest, distance_m(point.position, Point2<Map>{5, 0}));
    sharpest = std::max(sharpest, std::abs(point.curvature_per_m));
  }
  EXPECT_NEAR(nearest, options.max_corner_cut_m, 0.01);
  EXPECT_NEAR(1.0 / sharpest, options.max_corner_cut_m / (std::sqrt(2.0) - 1.0), 1e-9);
  EXPECT_NEAR(path.points.back().heading_rad, kPi / 2.0, 1e-9);
}

TEST(Waypoints, ASharpCornerIsTurnedOnTheSpot) {
  const auto path = make_waypoints(corners({{0, 0}, {2, 0}, {0, 0.5}})).value();
  int repeated = 0;
  for (std::size_t i = 1; i < path.points.size(); ++i)
    if (distance_m(path.points[i - 1].position, path.points[i].position) < 1e-9) {
      ++repeated;
      EXPECT_GT(std::abs(wrap_angle(path.points[i].heading_rad - path.points[i - 1].heading_rad)), 2.0);
    }
  EXPECT_EQ(repeated, 1);
}

TEST(Waypoints, TheFinalHeadingIsALastTurnOnTheSpot) {
  const auto path = make_waypoints(corners({{0, 0}, {1, 0}}), {}, kPi / 2.0).value();
  const auto& last = path.points.back();
  EXPECT_EQ(last.position, path.points[path.points.size() - 2].position);
  EXPECT_DOUBLE_EQ(last.heading_rad, kPi / 2.0);
  EXPECT_EQ(make_waypoints(corners({{0, 0}, {1, 0}}), {}, 0.0).value().points.size(), 11U);
}

TEST(Waypoints, EachLegKeepsItsSpeedLimit) {
  const auto path = make_waypoints({{{0, 0}, 9.0}, {{2, 0}, 0.5}, {{4, 0}, 1.0}}).value();
  EXPECT_EQ(path.points[5].speed_limit_mps, 0.5);
  EXPECT_EQ(path.points[35].speed_limit_mps, 1.0);
}

TEST(Waypoints, OnePointIsNoWay) {
  EXPECT_FALSE(make_waypoints(corners({{1, 1}, {1, 1}})));
}

TEST(Waypoints, AWayOfMillionsOfPointsIsRefused) {
  EXPECT_FALSE(make_waypoints(corners({{0, 0}, {9e5, 0}}), {.spacing_m = 0.01}));
  EXPECT_FALSE(make_waypoints(corners({{0, 0}, {1e300, 0}})));
  EXPECT_TRUE(make_waypoints(corners({{0, 0}, {1e5, 0}})));
}

TEST(Waypoints, TheFileIsAsPublished) {
  const auto path = make_waypoints(corners({{0, 0}, {0.2, 0}}), {}, 1.0).value();
  EXPECT_EQ(waypoints_csv(path), "ID,x,y\n0,0.000000,0.000000\n1,0.100000,0.000000\n2,0.200000,0.000000\n");
}

}  // namespace
}  // namespace madori::planning
