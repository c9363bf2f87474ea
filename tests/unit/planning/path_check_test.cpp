#include "planning/obstacle_check/path_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/angle.hpp"
#include "core/segment_distance.hpp"
#include "planning/obstacle_check/clearance.hpp"
#include "planning/waypoints/waypoints.hpp"
#include "tests/support/straight_way.hpp"

namespace madori::planning {
namespace {

using test::straight_way;

const CheckOptions kOptions;
const WallGrid kNoWalls;

TEST(PathCheck, AFreeWayIsFree) {
  const auto check = check_path(straight_way(6), 0, 5.0, {{3.0, 2.0}}, kNoWalls, kOptions);
  EXPECT_FALSE(check.blocked());
  EXPECT_EQ(check.care_m, PathCheck::kFree);
}

TEST(PathCheck, AnObstacleLeavesRoomForTheVehiclesFront) {
  const auto check = check_path(straight_way(8), 0, 7.0, {{5.0, 0.1}}, kNoWalls, kOptions);
  ASSERT_TRUE(check.blocked());
  EXPECT_LE(check.free_m, 5.0 - kOptions.vehicle.front_m - kOptions.ends_margin_m);
  EXPECT_GE(check.free_m, 5.0 - kOptions.vehicle.front_m - kOptions.ends_margin_m - 2.0 * kOptions.step_m);
  EXPECT_FALSE(check.by_wall);
  EXPECT_LE(check.care_m, check.free_m);
  EXPECT_GT(check.last_blocked, check.first_blocked);
  EXPECT_FALSE(check_path(straight_way(8), 0, 3.0, {{5.0, 0.1}}, kNoWalls, kOptions).blocked())
      << "beyond what is asked";
}

TEST(PathCheck, TheScannersProtectiveFieldStaysFree) {
  CheckOptions options;
  options.protective.ahead_m = 0.8;
  const auto check = check_path(straight_way(8), 0, 7.0, {{5.0, 0.1}}, kNoWalls, options);
  ASSERT_TRUE(check.blocked());
  EXPECT_LE(check.free_m, 5.0 - options.vehicle.front_m - options.protective.ahead_m);
  EXPECT_GE(check.free_m, 5.0 - options.vehicle.front_m - options.protective.ahead_m - 2.0 * options.step_m);
  EXPECT_FALSE(check_path(straight_way(3.3), 0, 7.0, {{5.0, 0.1}}, kNoWalls, options).blocked());
  EXPECT_TRUE(check_path(straight_way(3.5), 0, 7.0, {{5.0, 0.1}}, kNoWalls, options).blocked());
  const WallGrid walls(std::vector<Segment2<Map>>{{{5.0, -2.0}, {5.0, 2.0}}});
  EXPECT_FALSE(check_path(straight_way(3.3), 0, 7.0, {}, walls, options).blocked());
  EXPECT_TRUE(check_path(straight_way(3.5), 0, 7.0, {}, walls, options).by_wall)
      << "the scanner sees walls too";
}

TEST(PathCheck, TheFieldIsSweptByATurnAndReachesBesideTheVehicle) {
  CheckOptions options;
  options.protective = {0.7, 0.1};
  Path turn;
  turn.points.assign(2, PathPoint{{0.0, 0.0}, 0.0});
  turn.points.back().heading_rad = to_rad(90.0);
  const std::vector<Point2<Map>> within{{1.0, 1.0}}, beyond{{1.3, 1.3}}, aside{{1.0, -0.6}};
  EXPECT_TRUE(check_path(turn, 1, 0.0, within, kNoWalls, options).blocked())
      << "the front passes, not the field";
  EXPECT_FALSE(check_path(turn, 1, 0.0, within, kNoWalls, kOptions).blocked());
  EXPECT_FALSE(check_path(turn, 1, 0.0, beyond, kNoWalls, options).blocked());
  EXPECT_FALSE(check_path(turn, 1, 0.0, aside, kNoWalls, options).blocked()) << "it turns the other way";
  const double half_m = options.vehicle.half_width_m;
  EXPECT_FALSE(is_free({}, {{1.0, half_m + 0.12}}, kNoWalls, options));
  EXPECT_TRUE(is_free({}, {{1.0, half_m + 0.2}}, kNoWalls, options) &&
              is_free({}, {{0.2, half_m + 0.1}}, kNoWalls, options))
      << "beside the field, and beside the vehicle, where no field is";
}

TEST(PathCheck, SomethingBesideTheWayOnlyAsksForCare) {
  const double side = kOptions.vehicle.half_width_m + kOptions.sides_margin_m + 0.05;
  const auto check = check_path(straight_way(6), 0, 5.0, {{3.0, side}}, kNoWalls, kOptions);
  EXPECT_FALSE(check.blocked());
  EXPECT_LT(check.care_m, 3.0);
}

TEST(PathCheck, ADrawnWallBlocks) {
  const WallGrid walls(std::vector<Segment2<Map>>{{{4.0, -2.0}, {4.0, 2.0}}});
  const auto check = check_path(straight_way(8), 0, 7.0, {}, walls, kOptions);
  ASSERT_TRUE(check.blocked());
  EXPECT_TRUE(check.by_wall);
  EXPECT_NEAR(check.where.x_m, 4.0, 1e-9);
}

TEST(PathCheck, ATurnOnTheSpotSweepsItsCorners) {
  Path path = straight_way(2);
  PathPoint turn = path.points.back();
  turn.heading_rad = kPi;
  path.points.push_back(turn);
  const auto check = check_path(path, 0, 5.0, {{2.0, 0.7}}, kNoWalls, kOptions);
  ASSERT_TRUE(check.blocked()) << "free at both ends of the turn, not in its middle";
  EXPECT_EQ(check.first_blocked, path.points.size() - 1);
  EXPECT_NEAR(check.free_m, 2.0, 1e-9);
}

TEST(WallGrid, FindsEveryWallThatAFullSearchFinds) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-20.0, 20.0);
  std::vector<Segment2<Map>> walls;
  for (int i = 0; i < 200; ++i)
    walls.push_back({{place(random), place(random)}, {place(random), place(random)}});
  walls.push_back({{-5.0, 3.0}, {7.0, 3.0}});
  walls.push_back({{2.0, -9.0}, {2.0, 9.0}});
  const WallGrid grid(walls);
  for (int i = 0; i < 300; ++i) {
    const Point2<Map> centre{1.2 * place(random), 1.2 * place(random)};
    std::size_t expected = 0;
    for (const auto& wall : walls) expected += distance_m(wall, centre) <= 1.3 ? 1 : 0;
    std::vector<Segment2<Map>> found;
    grid.any_near(centre, 1.3, [&](const auto& wall) {
      if (distance_m(wall, centre) <= 1.3 && std::find(found.begin(), found.end(), wall) == found.end())
        found.push_back(wall);
      return false;
    });
    EXPECT_EQ(found.size(), expected);
  }
}

TEST(VehicleOutline, TouchesSegmentsThatCrossWithoutAnEndInside) {
  const VehicleOutline outline;
  EXPECT_TRUE(outline.touches({{0.3, -2.0}, {0.3, 2.0}}));
  EXPECT_TRUE(outline.touches({{-5.0, 0.0}, {5.0, 0.0}}));
  EXPECT_TRUE(outline.touches({{0.1, 0.1}, {0.2, 0.1}}));
  EXPECT_FALSE(outline.touches({{0.9, -2.0}, {0.9, 2.0}}));
  EXPECT_FALSE(outline.touches({{0.7, 0.5}, {1.0, 0.2}}));
}

TEST(PathCheck, WhatTheVehicleStandsAgainstIsLeftAndNotComeNearerTo) {
  const CheckOptions margins = with_margins(kOptions, {0.2, 0.0});
  const Transform2<Map, Base> here;
  const double behind_m = -kOptions.vehicle.rear_m - 0.01, beside_m = kOptions.vehicle.half_width_m + 0.005;
  std::vector<Point2<Map>> obstacles{{behind_m, 0.2}, {0.3, -beside_m}, {3.0, 2.0}};
  ASSERT_TRUE(check_path(straight_way(6), 0, 5.0, obstacles, kNoWalls, margins).blocked());
  set_back(obstacles, here, margins);
  EXPECT_TRUE(is_free(here, obstacles, kNoWalls, margins));
  EXPECT_FALSE(check_path(straight_way(6), 0, 5.0, obstacles, kNoWalls, margins).blocked());
  EXPECT_FALSE(is_free({-0.05, 0.0, 0.0}, obstacles, kNoWalls, margins)) << "back";
  EXPECT_FALSE(is_free({0.0, -0.05, 0.0}, obstacles, kNoWalls, margins)) << "aside";
  EXPECT_FALSE(is_free({0.0, 0.0, to_rad(20.0)}, obstacles, kNoWalls, margins)) << "its tail swings out";
  EXPECT_EQ(obstacles.back(), (Point2<Map>{3.0, 2.0})) << "nothing else is moved";
}

TEST(PathCheck, WhatIsInTheFieldOrDeepInTheOutlineStaysWhereItIs) {
  CheckOptions margins = with_margins(kOptions, {0.2, 0.0});
  margins.protective.ahead_m = 0.5;
  const std::vector<Point2<Map>> seen{{kOptions.vehicle.front_m + 0.3, 0.0}, {0.3, 0.0}};
  std::vector<Point2<Map>> obstacles = seen;
  set_back(obstacles, {}, margins);
  EXPECT_EQ(obstacles, seen);
}

/// Where the vehicle's map lies as it drives a path, every centimetre or so of a curve.
std::vector<Transform2<Base, Map>> swept(const Path& path) {
  constexpr int kParts = 20;
  std::vector<Transform2<Base, Map>> poses;
  for (std::size_t i = 1; i < path.points.size(); ++i) {
    const PathPoint &a = path.points[i - 1], &b = path.points[i];
    const double turn = wrap_angle(b.facing_rad() - a.facing_rad());
    for (int k = 0; k < kParts; ++k) {
      const double s = static_cast<double>(k) / kParts;
      const Transform2<Map, Base> pose(a.position.x_m + s * (b.position.x_m - a.position.x_m),
                                       a.position.y_m + s * (b.position.y_m - a.position.y_m),
                                       a.facing_rad() + s * turn);
      poses.push_back(pose.inverse());
    }
  }
  return poses;
}

TEST(PathCheck, NothingIsPassedInACurveNearerThanHalfTheMargin) {
  WaypointOptions sharp;
  sharp.corner_radius_m = sharp.min_radius_m;
  const Path path = make_waypoints({{{2, 0}}, {{3, 0}}, {{3, 1}}}, sharp).value();
  const auto poses = swept(path);
  CheckOptions wide = kOptions;
  wide.vehicle = {1.6, 0.4, 0.5, 0.8};
  for (const CheckOptions& options : {kOptions, with_margins(kOptions, {0.2, 0.0}), wide}) {
    for (double x = 2.5; x < 4.5; x += 0.05)
      for (double y = -1.2; y < 1.5; y += 0.05) {
        const Point2<Map> place{x, y};
        const bool near = std::ranges::any_of(poses, [&](const auto& base_from_map) {
          return clearance_m(options.vehicle, base_from_map * place) < 0.5 * options.turn_margin_m;
        });
        if (!near) continue;
        EXPECT_TRUE(check_path(path, 0, 10.0, {place}, kNoWalls, options).blocked())
            << x << ' ' << y << ", margin " << options.turn_margin_m;
      }
  }
}

TEST(WallGrid, AWallFarOffTheDrawingNeedsNoMoreRoom) {
  const WallGrid grid(std::vector<Segment2<Map>>{{{4.0, -2.0}, {4.0, 2.0}}, {{5e8, 3e8}, {5e8, 3e8 + 1.0}}});
  const auto all = [](const Segment2<Map>& /*wall*/) { return true; };
  EXPECT_TRUE(grid.any_near({3.0, 0.0}, 1.5, all));
  EXPECT_TRUE(grid.any_near({5e8, 3e8}, 1.5, all));
  EXPECT_FALSE(grid.any_near({2e8, 3e8}, 1.5, all));
}

}  // namespace
}  // namespace madori::planning
