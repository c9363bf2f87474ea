#include "planning/detour/dubins.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace madori::planning {
namespace {

using Pose = Transform2<Map, Base>;

Pose random_pose(std::mt19937_64& random, double reach_m) {
  std::uniform_real_distribution<double> place(-reach_m, reach_m);
  std::uniform_real_distribution<double> heading(-kPi, kPi);
  const double x = place(random);
  const double y = place(random);
  return {x, y, heading(random)};
}

double length(const Pose& a, const Pose& b) {
  return shortest_dubins(a, b, 0.45).length_m();
}

TEST(Dubins, EndsWhereItShouldAndTurnsNoSharper) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const double reach_m = i % 2 == 0 ? 0.8 : 8.0;
    const Pose from = random_pose(random, reach_m);
    const Pose to = random_pose(random, reach_m);
    const auto curve = shortest_dubins(from, to, 0.45);
    const Pose end = curve.pose_at(curve.length_m());
    ASSERT_LT(distance_m(end.translation(), to.translation()), 1e-6) << i;
    ASSERT_LT(std::abs(wrap_angle(end.yaw_rad() - to.yaw_rad())), 1e-7) << i;
    ASSERT_GE(curve.length_m(), distance_m(from.translation(), to.translation()) - 1e-9) << i;
    for (const auto& piece : curve.pieces) ASSERT_GE(piece.length, 0.0);
  }
}

// What is shortest obeys the triangle inequality, and is as long driven from the other end.
TEST(Dubins, IsAMetricButForItsDirection) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 20'000; ++i) {
    const double reach_m = i % 2 == 0 ? 0.6 : 5.0;
    const Pose a = random_pose(random, reach_m);
    const Pose b = random_pose(random, reach_m);
    const Pose c = random_pose(random, reach_m);
    ASSERT_LE(length(a, c), length(a, b) + length(b, c) + 1e-9) << i;
    const auto turned = [](const Pose& p) { return Pose(p.x_m(), p.y_m(), p.yaw_rad() + kPi); };
    ASSERT_NEAR(length(a, b), length(turned(b), turned(a)), 1e-6) << i;
  }
}

// Where OMPL's DubinsStateSpace ends the program.
TEST(Dubins, AHeadingAHairBesideTheLineIsNoLoop) {
  for (const double off_rad : {0.0, 1e-16, 1e-12, 1e-10, -1e-12, -1e-10})
    for (const double way_m : {0.5, 3.0, 30.0})
      EXPECT_NEAR(length({1.0, 2.0, off_rad}, {1.0 + way_m, 2.0, 0.0}), way_m, 1e-5) << off_rad;
  EXPECT_NEAR(length({1.0, 2.0, 0.3}, {1.0, 2.0, 0.3}), 0.0, 1e-9);
}

}  // namespace
}  // namespace madori::planning
