#include "simulation/world/traffic.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace madori::simulation {
namespace {

constexpr double kDt = 0.01;
const PlanFrames kFrames;
const VehicleCircle kFarAway{{1000.0, 1000.0}, 0.6};

MoverSpec walker() {
  MoverSpec spec;
  spec.name = "walker";
  spec.path = {{0.0, 0.0}, {4.0, 0.0}, {4.0, 3.0}};
  spec.speed_mps = 1.0;
  return spec;
}

TEST(Mover, WalksItsPathToAndFro) {
  Mover mover(walker(), kFrames);
  double now = 0.0;
  const auto walk = [&](double seconds) {
    for (int i = 0; i < std::lround(seconds / kDt); ++i, now += kDt) mover.advance(now, kDt, kFarAway);
  };
  walk(5.0);
  EXPECT_NEAR(mover.body().centre.x_m, 4.0, 1e-6);
  EXPECT_NEAR(mover.body().centre.y_m, 1.0, 1e-6);
  EXPECT_NEAR(mover.body().yaw_rad, kPi / 2.0, 1e-9);
  walk(3.0);  // to the end at 7 m and one back
  EXPECT_NEAR(mover.body().centre.y_m, 2.0, 0.02);
  EXPECT_NEAR(mover.body().yaw_rad, -kPi / 2.0, 1e-9);
}

TEST(Mover, APoliteOneStopsBeforeTheVehicleAndARudeOneDoesNot) {
  const VehicleCircle vehicle{{2.5, 0.0}, 0.6};
  for (const double polite_m : {0.8, 0.0}) {
    MoverSpec spec = walker();
    spec.polite_m = polite_m;
    Mover mover(spec, kFrames);
    for (int i = 0; i < 300; ++i) mover.advance(i * kDt, kDt, vehicle);
    if (polite_m > 0.0)
      EXPECT_NEAR(mover.body().centre.x_m, 2.5 - 0.8 - 0.6 - 0.23, 0.02);
    else
      EXPECT_NEAR(mover.body().centre.x_m, 3.0, 0.02);
  }
}

DoorSpec door(DoorKind kind) {
  DoorSpec spec;
  spec.kind = kind;
  spec.line = {{0.0, 0.0}, {0.0, 4.0}};
  spec.height_m = 3.0;
  spec.opening_s = 2.0;
  spec.trigger_m = 3.0;
  spec.hold_s = 1.0;
  return spec;
}

TEST(Door, ALiftDoorRisesForTheVehicleAndShutsAfterIt) {
  Door lift(door(DoorKind::Lift), kFrames);
  ASSERT_TRUE(lift.leaf());
  EXPECT_EQ(lift.leaf()->z.low_m, 0.0);
  double now = 0.0;
  const auto wait = [&](double seconds, double vehicle_x) {
    for (int i = 0; i < std::lround(seconds / kDt); ++i, now += kDt)
      lift.advance(now, kDt, {{vehicle_x, 2.0}, 0.6}, {});
  };
  wait(1.0, 3.0);
  ASSERT_TRUE(lift.leaf());
  EXPECT_NEAR(lift.leaf()->z.low_m, 1.5, 0.02);
  wait(1.1, 3.0);
  EXPECT_FALSE(lift.leaf());
  wait(3.2, 50.0);
  ASSERT_TRUE(lift.leaf());
  EXPECT_NEAR(lift.leaf()->z.low_m, 0.0, 0.02);
}

TEST(Door, ASlidingLeafDrawsBack) {
  Door sliding(door(DoorKind::Sliding), kFrames);
  for (int i = 0; i < 100; ++i) sliding.advance(i * kDt, kDt, {{2.0, 2.0}, 0.6}, {});
  ASSERT_TRUE(sliding.leaf());
  EXPECT_NEAR(sliding.leaf()->half_length_m, 1.0, 0.02);
  EXPECT_NEAR(sliding.leaf()->centre.y_m, 3.0, 0.02);
}

TEST(Door, OneThatIsStuckOpensNoFurtherUntilItIsMended) {
  DoorSpec spec = door(DoorKind::Lift);
  spec.stuck_at = 0.5;
  spec.stuck_until_s = 4.0;
  Door lift(spec, kFrames);
  double now = 0.0;
  const auto wait = [&](double seconds) {
    for (int i = 0; i < std::lround(seconds / kDt); ++i, now += kDt)
      lift.advance(now, kDt, {{2.0, 2.0}, 0.6}, {});
  };
  wait(3.9);
  EXPECT_NEAR(lift.openness(), 0.5, 1e-9);
  wait(1.3);
  EXPECT_EQ(lift.openness(), 1.0);
}

TEST(Door, NeverShutsOnTheVehicle) {
  DoorSpec spec = door(DoorKind::Lift);
  spec.trigger_m = 0.0;
  spec.period_s = 1000.0;
  spec.hold_s = 3.0;
  Door lift(spec, kFrames);
  for (int i = 0; i < 300; ++i) lift.advance(i * kDt, kDt, {{5.0, 2.0}, 0.6}, {});
  EXPECT_EQ(lift.openness(), 1.0);
  for (int i = 300; i < 1000; ++i) lift.advance(i * kDt, kDt, {{0.3, 2.0}, 0.6}, {});
  EXPECT_EQ(lift.openness(), 1.0);
  for (int i = 1000; i < 1300; ++i) lift.advance(i * kDt, kDt, {{5.0, 2.0}, 0.6}, {});
  EXPECT_EQ(lift.openness(), 0.0);
}

}  // namespace
}  // namespace madori::simulation
