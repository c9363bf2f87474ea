#include "control/wheel_watch/wheel_watch.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <deque>

namespace madori::control {
namespace {

constexpr double kStatusEveryS = 0.02;
const WheelWatchOptions kOptions;

/// A rim that obeys: late by a dead time, no quicker than `acceleration_mps2`, off by a share.
class Rim {
 public:
  Rim(double late_s, double acceleration_mps2, double share)
      : told_(static_cast<std::size_t>(late_s / kStatusEveryS) + 1),
        acceleration_mps2_(acceleration_mps2),
        share_(share) {}
  double turn(double asked_mps) {
    told_.push_back(asked_mps);
    told_.pop_front();
    const double step = acceleration_mps2_ * kStatusEveryS;
    speed_mps_ += std::clamp(share_ * told_.front() - speed_mps_, -step, step);
    return speed_mps_;
  }

 private:
  std::deque<double> told_;
  double acceleration_mps2_, share_, speed_mps_ = 0.0;
};

VelocityCommand command_of(double left_mps, double right_mps) {
  return {(left_mps + right_mps) / 2.0, (right_mps - left_mps) / (2.0 * kOptions.half_separation_m)};
}

/// Seconds until the watch speaks; nothing where it never does.
std::optional<double> said_after(WheelWatch& watch, double seconds, double asked_mps, double left_mps,
                                 double right_mps) {
  for (double t = 0.0; t < seconds; t += kStatusEveryS)
    if (watch.update(command_of(asked_mps, asked_mps), command_of(left_mps, right_mps), kStatusEveryS,
                     kOptions))
      return t;
  return std::nullopt;
}

RC_GTEST_PROP(WheelWatch, AWheelThatObeysIsNeverSaidNotTo, ()) {
  const auto percent = [](int from, int to) { return 0.01 * *rc::gen::inRange(from, to + 1); };
  const double late_s = percent(0, 25), quick_mps2 = kOptions.acceleration_mps2 * percent(100, 400);
  Rim left(late_s, quick_mps2, percent(85, 115)), right(late_s, quick_mps2, percent(85, 115));
  WheelWatch watch;
  double asked_left = 0.0, asked_right = 0.0;
  for (int leg = 0; leg < 20; ++leg) {
    const bool stops = *rc::gen::inRange(0, 4) == 0;  // at once, as a stop is never delayed
    const double to_left = stops ? 0.0 : percent(-50, 150), to_right = stops ? 0.0 : percent(-50, 150);
    for (int k = *rc::gen::inRange(5, 100); k > 0; --k) {
      const double step = stops ? 10.0 : kOptions.acceleration_mps2 * kStatusEveryS;
      asked_left += std::clamp(to_left - asked_left, -step, step);
      asked_right += std::clamp(to_right - asked_right, -step, step);
      const auto found =
          watch.update(command_of(asked_left, asked_right),
                       command_of(left.turn(asked_left), right.turn(asked_right)), kStatusEveryS, kOptions);
      RC_ASSERT(!found);
    }
  }
}

TEST(WheelWatch, AMotorThatFailsIsNamed) {
  WheelWatch watch;
  ASSERT_FALSE(said_after(watch, 3.0, 0.8, 0.8, 0.8));
  std::optional<DisobedientWheel> found;
  double after_s = 0.0;
  for (; !found && after_s < 1.0; after_s += kStatusEveryS)
    found = watch.update(command_of(0.8, 0.8), command_of(0.8, 0.0), kStatusEveryS, kOptions);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->left);
  EXPECT_NEAR(found->asked_mps, 0.8, 1e-9);
  EXPECT_NEAR(found->turned_mps, 0.0, 1e-9);
  EXPECT_LT(after_s, 0.15);
  EXPECT_FALSE(watch.update(command_of(0.8, 0.8), command_of(0.8, 0.0), kStatusEveryS, kOptions)) << "twice";
}

TEST(WheelWatch, HalfTheSpeedIsTooLittleAndASingleReadingIsNothing) {
  WheelWatch watch;
  ASSERT_FALSE(said_after(watch, 3.0, 1.0, 1.0, 1.0));
  EXPECT_FALSE(said_after(watch, 0.04, 1.0, 9.0, 1.0)) << "a damaged reading";
  EXPECT_FALSE(said_after(watch, 1.0, 1.0, 1.0, 0.85)) << "a loaded wheel";
  EXPECT_TRUE(said_after(watch, 1.0, 1.0, 1.0, 0.5));
}

TEST(WheelWatch, AWheelThatRunsAwayFromAStandstillIsNamed) {
  WheelWatch watch;
  EXPECT_FALSE(said_after(watch, 1.0, 0.0, 0.0, 0.0));
  EXPECT_TRUE(said_after(watch, 1.0, 0.0, 0.5, 0.0));
}

TEST(WheelWatch, AVehicleThatIsHeldIsNoMatterOfAWheel) {
  for (const double asked_mps : {0.8, 0.4, -0.4, -0.8}) {
    WheelWatch watch;
    ASSERT_FALSE(said_after(watch, 3.0, asked_mps, asked_mps, asked_mps));
    EXPECT_FALSE(said_after(watch, 2.0, asked_mps, 0.0, 0.1 * asked_mps)) << asked_mps;
    EXPECT_TRUE(said_after(watch, 0.5, asked_mps, -asked_mps, 0.1 * asked_mps)) << "one runs the wrong way";
  }
}

TEST(WheelWatch, WhereTheDriveFollowsNoCommandNothingIsJudged) {
  WheelWatch watch;
  for (int k = 0; k < 100; ++k)
    EXPECT_FALSE(watch.update(std::nullopt, command_of(0.9, 0.9), kStatusEveryS, kOptions)) << "it is pushed";
  EXPECT_FALSE(said_after(watch, 0.3, 0.0, 0.7, 0.7)) << "it brakes from there";
  for (int k = 0; k < 4; ++k)
    EXPECT_FALSE(watch.update(std::nullopt, command_of(1.5, 1.5), kStatusEveryS, kOptions)) << "a jolt";
  EXPECT_FALSE(said_after(watch, 0.3, 0.0, 1.4, 1.4)) << "and from there";
}

}  // namespace
}  // namespace madori::control
