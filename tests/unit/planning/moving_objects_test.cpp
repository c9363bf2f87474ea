#include "planning/obstacle_check/moving_objects.hpp"

#include <gtest/gtest.h>

#include "core/angle.hpp"
#include "planning/waypoints/waypoints.hpp"
#include "tests/support/toy_lidar.hpp"

namespace madori::planning {
namespace {

const SensorView kVlp{0.0, 0.0, 0.9, to_rad(-15.0), to_rad(15.0)};

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

Path straight() {
  return make_waypoints({{{0, 0}}, {{10, 0}}}).value();
}

TEST(CheckMovers, ACrossingThatMeetsTheVehicleBlocksAndOneThatIsOverDoesNot) {
  const Mover<Map> meets{{3.0, -2.5}, 0.0, 1.2, 0.2};
  const auto check = check_movers(straight(), 0, 7.0, 1.0, {meets}, {}, {});
  ASSERT_TRUE(check.blocked());
  EXPECT_LT(check.free_m, 3.0 - CheckOptions().vehicle.front_m);
  const Mover<Map> leaves{{3.0, 1.5}, 0.0, 1.2, 0.2};
  EXPECT_FALSE(check_movers(straight(), 0, 7.0, 1.0, {leaves}, {}, {}).blocked());
  const Mover<Map> far{{9.0, -1.5}, 0.0, 1.5, 0.2};
  EXPECT_FALSE(check_movers(straight(), 0, 7.0, 0.5, {far}, {}, {}).blocked())
      << "gone long before the vehicle comes";
}

}  // namespace
}  // namespace madori::planning
