#include "core/angle.hpp"

#include <gtest/gtest.h>

namespace madori {
namespace {

TEST(WrapAngle, StaysInTheHalfOpenInterval) {
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), -kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), -kPi);
  EXPECT_NEAR(wrap_angle(7.0 * kPi + 0.25), -kPi + 0.25, 1e-12);
  for (int i = -1000; i <= 1000; ++i) {
    const double wrapped = wrap_angle(0.037 * i);
    EXPECT_GE(wrapped, -kPi);
    EXPECT_LT(wrapped, kPi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(0.037 * i), 1e-12);
    EXPECT_NEAR(std::sin(wrapped), std::sin(0.037 * i), 1e-12);
  }
}

TEST(WrapAngle, KeepsNotANumber) {
  EXPECT_TRUE(std::isnan(wrap_angle(std::nan(""))));
}

}  // namespace
}  // namespace madori
