#include "mapping/drawing/raster/skew.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace madori::mapping {
namespace {

PixelSegment turned(double u, double v, double length, double counter_clockwise_deg) {
  const double a = counter_clockwise_deg * std::numbers::pi / 180;
  return {u, v, u + length * std::cos(a), v - length * std::sin(a)};
}

TEST(Skew, IsCounterClockwiseOnTheDrawing) {
  const std::vector<PixelSegment> walls{turned(0, 500, 400, 1.3), turned(0, 900, 300, 91.3),
                                        turned(50, 50, 90, 30)};
  EXPECT_NEAR(measure_skew_deg(walls), 1.3, 0.02);
}

TEST(Skew, NegativeAndNearHalfARightAngle) {
  EXPECT_NEAR(measure_skew_deg({turned(0, 0, 100, -2.2)}), -2.2, 0.02);
  EXPECT_NEAR(measure_skew_deg({turned(0, 0, 100, 134.0)}), 44.0, 0.02);
  EXPECT_EQ(measure_skew_deg({}), 0);
}

TEST(Skew, StraighteningTurnsAboutTheMiddleAndLeavesSlantedWallsAlone) {
  std::vector<PixelSegment> walls{turned(100, 100, 200, 1.4), turned(100, 100, 200, 20)};
  const PixelSegment before = walls[0], slanted = walls[1];
  straighten(walls, 1.3);
  EXPECT_NEAR(measure_skew_deg({walls[0]}), 1.3, 1e-6);
  EXPECT_NEAR(walls[0].u1 + walls[0].u2, before.u1 + before.u2, 1e-9);
  EXPECT_NEAR(walls[0].v1 + walls[0].v2, before.v1 + before.v2, 1e-9);
  EXPECT_EQ(walls[1], slanted);
}

}  // namespace
}  // namespace madori::mapping
