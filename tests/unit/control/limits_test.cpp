#include "control/limits/limits.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace madori::control {
namespace {

const LimitOptions kLimitOptions;
constexpr double kStepS = 0.02;
const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

TEST(Limits, AStartIsSmoothAndReachesTheRequest) {
  LimitState state;
  double fastest_growth = 0.0;
  double previous = 0.0;
  for (int i = 0; i < 200; ++i) {
    const auto out = limit(state, {.requested = {1.0, 0.0}, .step_s = kStepS}, kLimitOptions);
    fastest_growth = std::max(fastest_growth, (out.command.linear_mps - previous) / 0.02);
    previous = out.command.linear_mps;
    state = out.state;
    if (i == 0) {
      EXPECT_NEAR(previous, kLimitOptions.jerk_mps3 * kStepS * kStepS, 1e-12);
    }
  }
  EXPECT_DOUBLE_EQ(previous, 1.0);
  EXPECT_NEAR(fastest_growth, kLimitOptions.acceleration_mps2, 1e-9);
}

TEST(Limits, AStopIsNeverDelayed) {
  const LimitState driving{{1.0, 0.5}, 0.0};
  EXPECT_EQ(limit(driving, {.requested = {0.0, 0.0}, .step_s = kStepS}, kLimitOptions).command,
            VelocityCommand{});
  EXPECT_EQ(
      limit(driving, {.requested = {1.0, 0.5}, .may_move = false, .step_s = kStepS}, kLimitOptions).command,
      VelocityCommand{});
  EXPECT_EQ(limit(driving, {.requested = {1.0, 0.5}, .speed_cap_mps = 0.0, .step_s = kStepS}, kLimitOptions)
                .command,
            VelocityCommand{});
}

TEST(Limits, WhatIsNotFiniteStops) {
  const LimitState driving{{1.0, 0.0}, 0.0};
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    EXPECT_EQ(limit(driving, {.requested = {bad, 0.0}, .step_s = kStepS}, kLimitOptions).command,
              VelocityCommand{});
    EXPECT_EQ(limit(driving, {.requested = {0.5, bad}, .step_s = kStepS}, kLimitOptions).command,
              VelocityCommand{});
  }
  EXPECT_EQ(limit(driving, {.requested = {0.5, 0.0}, .speed_cap_mps = kNan, .step_s = kStepS}, kLimitOptions)
                .command,
            VelocityCommand{});
  EXPECT_EQ(limit(driving, {.requested = {0.5, 0.0}, .step_s = 0.0}, kLimitOptions).command,
            VelocityCommand{});
}

TEST(Limits, ASpeedCapKeepsTheCurve) {
  const LimitState driving{{1.0, 0.6}, 0.0};
  const auto out =
      limit(driving, {.requested = {1.0, 0.6}, .speed_cap_mps = 0.5, .step_s = kStepS}, kLimitOptions);
  EXPECT_DOUBLE_EQ(out.command.linear_mps, 0.5);
  EXPECT_DOUBLE_EQ(out.command.angular_radps, 0.3);
}

TEST(Limits, TheOuterWheelKeepsItsLimit) {
  const LimitState driving{{1.0, 1.0}, 0.0};
  LimitOptions options;
  options.max_wheel_speed_mps = 1.0;
  const auto out = limit(driving, {.requested = {1.0, 1.0}, .step_s = kStepS}, options).command;
  EXPECT_NEAR(out.linear_mps + out.angular_radps * options.half_wheel_separation_m, 1.0, 1e-12);
}

TEST(Limits, ReversalBeginsFromStandstill) {
  const LimitState driving{{0.8, 0.0}, 0.0};
  const auto out = limit(driving, {.requested = {-0.8, 0.0}, .step_s = kStepS}, kLimitOptions);
  EXPECT_NEAR(out.command.linear_mps, -kLimitOptions.jerk_mps3 * kStepS * kStepS, 1e-12);
}

}  // namespace
}  // namespace madori::control
