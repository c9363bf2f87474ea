#include "planning/obstacle_check/motion_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace madori::planning {
namespace {

constexpr double kStepS = 0.02;
const VehicleOutline kVehicle;
const BrakingModel kBraking;

Transform2<Map, Base> after(const Transform2<Map, Base>& pose, const VelocityCommand& v, double time_s) {
  constexpr int kParts = 20;
  Transform2<Map, Base> end = pose;
  for (int i = 0; i < kParts; ++i)
    end =
        end * Transform2<Base, Base>(v.linear_mps * time_s / kParts, 0.0, v.angular_radps * time_s / kParts);
  return end;
}

double share(const Transform2<Map, Base>& pose, const VelocityCommand& v,
             const std::vector<Point2<Map>>& bodies, const WallGrid& walls = WallGrid()) {
  return guarded_share(pose, v, bodies, walls, kVehicle, kBraking);
}

TEST(MotionGuard, LeavesACommandAloneThatLeadsNowhereNear) {
  EXPECT_EQ(share({}, {1.0, 0.0}, {}), 1.0);
  EXPECT_EQ(share({}, {1.0, 0.0}, {{2.2, 0.0}}), 1.0)
      << "braking takes 0.98 m, and the bumper is 0.8 m ahead";
  EXPECT_EQ(share({}, {1.0, 0.0}, {{1.2, 0.4}}), 1.0) << "beside the way";
  EXPECT_EQ(share({}, {0.0, 1.0}, {{0.95, 0.0}}), 1.0) << "beyond the swept circle";
  EXPECT_EQ(share({}, {0.0, 0.0}, {{0.81, 0.0}}), 1.0);
}

TEST(MotionGuard, SlowsTheVehicleDownBeforeWhatItWouldMeet) {
  EXPECT_LT(share({}, {1.0, 0.0}, {{1.6, 0.0}}), 1.0);
  EXPECT_LT(share({}, {0.3, 0.9}, {{0.75, 0.5}}), 0.9) << "the nose swings to the left";
  EXPECT_EQ(share({}, {0.3, -0.9}, {{0.75, 0.5}}), 1.0);
  EXPECT_LT(share({}, {0.0, 1.0}, {{0.78, 0.33}}), 0.2);
  const double corner_rad = std::atan2(kVehicle.half_width_m, kVehicle.front_m) + 0.3;
  const double passed_m = kVehicle.reach_m() + 0.9 * GuardOptions().body_margin_m;
  EXPECT_LT(share({}, {0.0, 1.0}, {{passed_m * std::cos(corner_rad), passed_m * std::sin(corner_rad)}}), 1.0);
  const WallGrid wall(std::vector<Segment2<Map>>{{{-5.0, 0.4}, {5.0, 0.4}}});
  EXPECT_LT(share({}, {0.3, 0.9}, {}, wall), 0.9);
  EXPECT_EQ(share({}, {1.0, 0.0}, {}, wall), 1.0);
}

TEST(MotionGuard, AVehicleThatStandsTooNearMayLeaveButNotComeNearer) {
  for (const double away_m : {0.015, 0.005, -0.01}) {
    const std::vector<Point2<Map>> ahead{{0.8 + away_m, 0.0}};
    EXPECT_LT(share({}, {0.5, 0.0}, ahead), 0.15) << away_m;
    EXPECT_EQ(share({}, {-0.5, 0.0}, ahead), 1.0) << away_m;
  }
}

/// Driven again and again under the guard with a drive that answers late, the vehicle touches nothing.
TEST(MotionGuard, WhateverIsAskedNothingIsTouched) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-3.0, 3.0), speed(-1.0, 1.0);
  int stopped = 0;
  for (int run = 0; run < 300; ++run) {
    std::vector<Point2<Map>> bodies;
    while (bodies.size() < 12) {
      const Point2<Map> p{place(random), place(random)};
      if (!kVehicle.grown(0.05, 0.05).contains(Transform2<Base, Map>() * p)) bodies.push_back(p);
    }
    const VelocityCommand asked{speed(random), speed(random)};
    Transform2<Map, Base> pose;
    VelocityCommand driven;
    for (int i = 0; i < 200; ++i) {
      const double s = share(pose, asked, bodies);
      const double follow = 1.0 - std::exp(-kStepS / 0.1);
      driven.linear_mps += follow * (asked.linear_mps * s - driven.linear_mps);
      driven.angular_radps += follow * (asked.angular_radps * s - driven.angular_radps);
      pose = after(pose, driven, kStepS);
      for (const auto& body : bodies)
        ASSERT_FALSE(kVehicle.contains(pose.inverse() * body)) << run << ", " << i;
    }
    stopped += share(pose, asked, bodies) < 0.3 ? 1 : 0;
  }
  EXPECT_GT(stopped, 100);
}

}  // namespace
}  // namespace madori::planning
