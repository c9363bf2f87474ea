#include "localization/warp/drawing_warp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace madori::localization {
namespace {

/// Control points of any size for which the steps between neighbours stay below half the spacing.
DrawingWarp random_warp(std::uint32_t seed, double step) {
  std::mt19937 engine(seed);
  WarpField field;
  field.origin = {-3.0, -5.0};
  field.spacing_m = 3.0;
  field.width = 9;
  field.height = 7;
  std::uniform_real_distribution<double> control(-0.5 * step * field.spacing_m, 0.5 * step * field.spacing_m);
  for (int i = 0; i < 2 * field.width * field.height; ++i) field.control_m.push_back(control(engine));
  field.sigma_m.assign(static_cast<std::size_t>(field.width * field.height), 0.02);
  return {{1.013, 0.03, 0.4, -0.7}, field, {}};
}

TEST(DrawingWarp, DefaultIsIdentityToTheBit) {
  const DrawingWarp none;
  EXPECT_TRUE(none.is_identity());
  EXPECT_EQ(none.building(Point2<Map>{1.2345, -6.789}), (Point2<Building>{1.2345, -6.789}));
  EXPECT_EQ(none.map(Point2<Building>{1.2345, -6.789}), (Point2<Map>{1.2345, -6.789}));
  const Transform2<Building, Base> pose = none.building(Transform2<Map, Base>(1.0, 2.0, 0.3));
  EXPECT_EQ(pose.yaw_rad(), 0.3);
  EXPECT_EQ(none.sigma_m({1.0, 2.0}), 0.0);
}

TEST(DrawingWarp, TheSteepestStepIsBetweenNeighboursOnly) {
  WarpField field;
  EXPECT_EQ(steepest_step_m(field), 0.0);
  field.width = 2;
  field.height = 2;
  field.control_m = {0.0, 0.0, 0.3, 0.4, 0.0, 0.1, 0.3, 0.5};  // and across the corners 0.58 m
  EXPECT_NEAR(steepest_step_m(field), 0.5, 1e-12);
  field.control_m[2] = field.control_m[3] = 0.0;  // the last is off alone
  EXPECT_NEAR(steepest_step_m(field), std::hypot(0.3, 0.5), 1e-12);
}

TEST(DrawingWarp, MapUndoesBuildingForPointsAndPoses) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const DrawingWarp warp = random_warp(seed, 0.45);
    EXPECT_FALSE(warp.is_identity());
    for (double x = -12.0; x < 35.0; x += 2.3) {
      const Transform2<Map, Base> pose(x, 0.4 * x, 0.2 * x);
      const Transform2<Map, Base> back = warp.map(warp.building(pose));
      EXPECT_LT(distance_m(back.translation(), pose.translation()), 1e-5);
      EXPECT_NEAR(wrap_angle(back.yaw_rad() - pose.yaw_rad()), 0.0, 1e-5);
    }
  }
}

TEST(DrawingWarp, TheHeadingTurnsAsALineOfPointsDoes) {
  const WarpSimilarity turned{1.0, 0.1, 3.0, 4.0};
  const DrawingWarp warp(turned, {}, {});
  const Transform2<Building, Base> pose = warp.building(Transform2<Map, Base>(5.0, 6.0, 0.5));
  EXPECT_NEAR(pose.yaw_rad(), 0.6, 1e-12);
  const Point2<Building> expected{std::cos(0.1) * 5.0 - std::sin(0.1) * 6.0 + 3.0,
                                  std::sin(0.1) * 5.0 + std::cos(0.1) * 6.0 + 4.0};
  EXPECT_LT(distance_m(pose.translation(), expected), 1e-12);
}

TEST(DrawingWarp, FarFromTheLatticeOnlyTheSizeIsLeft) {
  const DrawingWarp warp = random_warp(3, 0.4);
  const DrawingWarp size(warp.similarity(), {}, {});
  const Point2<Map> far{500.0, -300.0};
  EXPECT_EQ(warp.building(far), size.building(far));
  EXPECT_NEAR(warp.sigma_m(far), warp.statistics().amplitude_m, 1e-12);
  EXPECT_NEAR(warp.sigma_m({6.0, 4.0}), 0.02, 1e-9);
}

TEST(DrawingWarp, IsContinuousAcrossTheBorderOfTheLattice) {
  const DrawingWarp warp = random_warp(5, 0.4);
  Point2<Building> before = warp.building({-16.0, 3.0});
  for (double x = -16.0; x < 36.0; x += 0.001) {
    const Point2<Building> here = warp.building({x, 3.0});
    EXPECT_LT(distance_m(before, here), 0.002);
    before = here;
  }
}

}  // namespace
}  // namespace madori::localization
