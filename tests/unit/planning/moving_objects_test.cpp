#include "planning/obstacle_check/moving_objects.hpp"

#include <gtest/gtest.h>

#include "core/angle.hpp"
#include "tests/support/straight_way.hpp"
#include "tests/support/toy_lidar.hpp"

namespace madori::planning {
namespace {

using test::kVlp;

/// Ten revolutions of a standing lidar while `move` shifts the bodies; the movers at the end.
template <class Move>
std::vector<Mover<Odom>> watch(test::ToyLidar lidar, Move&& move) {
  std::mt19937 random(1);
  ObstacleField field;
  MovingObjects objects;
  for (int i = 0; i < 10; ++i) {
    move(lidar);
    const Stamp stamp = stamp_from_seconds(0.1 * i);
    field.update(lidar.scan({}, stamp, random), kVlp, {});
    objects.update(field.columns(), stamp);
  }
  return objects.movers();
}

TEST(MovingObjects, APersonsVelocityIsMeasured) {
  test::ToyLidar lidar;
  lidar.posts.push_back({{3.0, -2.0}, 0.18, 1.7});
  const auto movers = watch(lidar, [](auto& l) { l.posts[0].at.y_m += 0.12; });
  ASSERT_EQ(movers.size(), 1U);
  EXPECT_NEAR(movers[0].vy_mps, 1.2, 0.2);
  EXPECT_NEAR(movers[0].vx_mps, 0.0, 0.2);
  EXPECT_NEAR(movers[0].at.y_m, -0.8, 0.2);
}

TEST(MovingObjects, WhatStandsDoesNotMove) {
  test::ToyLidar lidar;
  for (int i = 0; i < 6; ++i) lidar.posts.push_back({{2.0 + 0.8 * i, 1.5}, 0.2, 1.7});
  EXPECT_TRUE(watch(lidar, [](auto& /*lidar*/) {}).empty());
}

TEST(MovingObjects, APersonRightBesideAShelfIsFollowed) {
  test::ToyLidar lidar;
  for (int i = 0; i < 40; ++i)
    lidar.posts.push_back({{3.5, -2.0 + 0.1 * i}, 0.06, 1.8});  // the shelf's front
  lidar.posts.push_back({{3.1, -2.5}, 0.2, 1.75});
  const auto movers = watch(lidar, [](auto& l) { l.posts.back().at.y_m += 0.14; });
  ASSERT_EQ(movers.size(), 1U);
  EXPECT_NEAR(movers[0].vy_mps, 1.4, 0.3);
  EXPECT_NEAR(movers[0].vx_mps, 0.0, 0.3);
}

TEST(MovingObjects, WhatOnlyComesIntoSightDoesNotMove) {
  test::ToyLidar lidar;
  for (int i = 0; i < 120; ++i)
    lidar.posts.push_back({{-2.0 + 0.1 * i, 2.5}, 0.06, 1.8});                     // a wall beside the way
  for (const double x : {1.0, 3.5}) lidar.posts.push_back({{x, 1.3}, 0.15, 1.7});  // pillars before it
  std::mt19937 random(1);
  ObstacleField field;
  MovingObjects objects;
  for (int i = 0; i < 50; ++i) {
    const Stamp stamp = stamp_from_seconds(0.1 * i);
    const double x = 0.1 * i;
    field.update(lidar.scan({x, 0.0, 0.0}, stamp, random), kVlp, {x, 0.0, 0.0});
    objects.update(field.columns(), stamp);
    EXPECT_TRUE(objects.movers().empty()) << "after " << x << " m";
  }
}

TEST(MovingObjects, APersonBesideTheLidarIsStillFollowedByTheUpperPart) {
  test::ToyLidar lidar;
  lidar.height_m = 1.2;
  lidar.posts.push_back({{0.9, -1.6}, 0.2, 1.75});
  const SensorView view{0.0, 0.0, 1.2, to_rad(-15.0), to_rad(15.0)};
  std::mt19937 random(1);
  ObstacleField field;
  MovingObjects objects;
  for (int i = 0; i < 16; ++i) {
    const Stamp stamp = stamp_from_seconds(0.1 * i);
    lidar.posts[0].at.y_m += 0.1;
    field.update(lidar.scan({}, stamp, random), view, {});
    objects.update(field.columns(), stamp);
  }
  ASSERT_EQ(objects.movers().size(), 1U) << "0.9 m before the lidar, where no beam reaches below 0.95 m";
  EXPECT_NEAR(objects.movers()[0].vy_mps, 1.0, 0.3);
}

TEST(CheckMovers, ACrossingThatMeetsTheVehicleBlocksAndOneThatIsOverDoesNot) {
  const Mover<Map> meets{{3.0, -2.5}, 0.0, 1.2, 0.2};
  const auto check = check_movers(test::straight_way(10), 0, 7.0, 1.0, {meets}, {}, {});
  ASSERT_TRUE(check.blocked());
  EXPECT_LT(check.free_m, 3.0 - CheckOptions().vehicle.front_m);
  const Mover<Map> leaves{{3.0, 1.5}, 0.0, 1.2, 0.2};
  EXPECT_FALSE(check_movers(test::straight_way(10), 0, 7.0, 1.0, {leaves}, {}, {}).blocked());
  const Mover<Map> far{{9.0, -1.5}, 0.0, 1.5, 0.2};
  EXPECT_FALSE(check_movers(test::straight_way(10), 0, 7.0, 0.5, {far}, {}, {}).blocked())
      << "gone long before the vehicle comes";
}

TEST(CheckMovers, AStandingVehicleDoesNotSetOffBeforeSomebodyWhoWillCrossItsWay) {
  const Mover<Map> comes{{2.2, -3.0}, 0.0, 1.4, 0.2};
  EXPECT_TRUE(check_movers(test::straight_way(10), 0, 7.0, 0.0, {comes}, {}, {}).blocked());
}

TEST(CheckMovers, WhoComesIntoTheCircleOfATurnHoldsIt) {
  const Transform2<Map, Base> pose(0.0, 0.0, 0.0);
  const MoverOptions options;
  EXPECT_TRUE(turn_meets(pose, {{{0.0, -2.2}, 0.0, 1.2, 0.2}}, {}, options)) << "comes";
  EXPECT_FALSE(turn_meets(pose, {{{0.0, -2.2}, 0.0, -1.2, 0.2}}, {}, options)) << "leaves";
  EXPECT_FALSE(turn_meets(pose, {{{0.0, -4.0}, 0.0, 1.2, 0.2}}, {}, options)) << "later";
}

/// A column that came there, as the field gives it.
Column come_to(double x_m, Stamp stamp) {
  Column c;
  c.min_x_m = c.max_x_m = static_cast<float>(x_m);
  c.cell_x = static_cast<std::int32_t>(std::floor(10.0 * x_m));
  c.confirmed = c.entered = true;
  c.high_m = 1.7F;
  c.seen = stamp;
  return c;
}

/// One goes along x from the first second on, seen five times a second.
void walk(MovingObjects& objects, double speed_mps) {
  for (int i = 0; i < 6; ++i) {
    const Stamp stamp = stamp_from_seconds(1.0 + 0.2 * i);
    objects.update({come_to(0.2 * speed_mps * i, stamp)}, stamp);
  }
}

std::vector<Mover<Odom>> at_speed(double speed_mps) {
  MovingObjects objects;
  walk(objects, speed_mps);
  return objects.movers();
}

TEST(MovingObjects, ALidarThatTurnsSlowlyMeasuresThemToo) {
  ASSERT_EQ(at_speed(1.2).size(), 1U);
  EXPECT_NEAR(at_speed(1.2)[0].vx_mps, 1.2, 0.01);
}

TEST(MovingObjects, WhatIsTooSlowIsMeasuredAsIfItStood) {
  const double slowest_mps = MoverOptions().slowest_mps;
  EXPECT_TRUE(at_speed(0.8 * slowest_mps).empty());
  EXPECT_EQ(at_speed(1.2 * slowest_mps).size(), 1U);
}

TEST(MovingObjects, WhoComesNextInheritsNothingOfWhoLeft) {
  MovingObjects objects;
  walk(objects, 1.2);
  objects.update({}, stamp_from_seconds(2.2));
  for (int k = 0; k < 6; ++k) {
    const Stamp stamp = stamp_from_seconds(2.4 + 0.2 * k);
    Column low = come_to(5.0, stamp);
    low.high_m = 0.4F;
    objects.update({low}, stamp);
    EXPECT_TRUE(objects.movers().empty()) << "it stands";
    ASSERT_EQ(objects.tracks().size(), 1U);
    EXPECT_NEAR(objects.tracks()[0].high_m, 0.4, 1e-6);
  }
}

/// When a vehicle that gains speed at once has driven so far, step by step.
double gained_s(double way_m, double speed_mps, const MoverOptions& options) {
  constexpr double kTickS = 1e-3;
  double time_s = 0.0;
  for (double along_m = 0.0; along_m < way_m; time_s += kTickS) {
    along_m += speed_mps * kTickS;
    speed_mps = std::max(speed_mps, std::min(options.top_speed_mps, speed_mps + options.gain_mps2 * kTickS));
  }
  return time_s;
}

/// Somebody walks straight across the way: who would be met by a vehicle that gains speed at once, or by one
/// that keeps its own, holds it; not who has left before the earliest could come, and a while more.
TEST(CheckMovers, WhoIsMetAtAnyPaceHoldsAndWhoHasLeftBeforeDoesNot) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> speed(0.0, 1.2), place(1.5, 4.0), walk(0.8, 2.0), gain(0.2, 1.5);
  const CheckOptions check;
  int held = 0, left = 0;
  for (int run = 0; run < 300; ++run) {
    MoverOptions options;
    options.gain_mps2 = gain(random);
    const double speed_mps = speed(random), across_m = place(random), walk_mps = walk(random);
    const auto blocks = [&](double y_m) {
      const Mover<Map> m{{across_m, y_m}, 0.0, walk_mps, 0.2};
      return check_movers(test::straight_way(10), 0, 7.0, speed_mps, {m}, check, options).blocked();
    };
    for (const double met_s : {gained_s(across_m, speed_mps, options), across_m / std::max(speed_mps, 0.3)}) {
      if (met_s > options.foresight_s) continue;
      EXPECT_TRUE(blocks(-walk_mps * met_s)) << "at " << speed_mps << " m/s, met after " << met_s;
      ++held;
    }
    const double margin_m = 0.2 + options.margin_m;
    const double front_m = across_m - check.vehicle.front_m - margin_m;
    const double gone_s = gained_s(front_m, speed_mps, options) - options.window_s - 0.05;
    if (gone_s < 0.0) continue;
    EXPECT_FALSE(blocks(check.vehicle.half_width_m + margin_m - walk_mps * gone_s))
        << "left after " << gone_s;
    ++left;
  }
  EXPECT_GT(held, 100);
  EXPECT_GT(left, 100);
}

TEST(CheckMovers, AVehicleThatDrivesBackwardMeetsTheSame) {
  Path back = test::straight_way(3);
  for (PathPoint& point : back.points) point.reverse = true;
  const std::vector<Mover<Map>> crossing{{{1.8, -1.6}, 0.0, 1.6, 0.25}};
  const auto ahead = check_movers(back, 0, 3.0, 0.3, crossing, {}, {});
  ASSERT_TRUE(ahead.blocked());
  EXPECT_EQ(check_movers(back, 0, 3.0, -0.3, crossing, {}, {}).free_m, ahead.free_m);
}

}  // namespace
}  // namespace madori::planning
