#include "control/braking/measured_stop.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace madori::control {
namespace {

/// A vehicle of an even speed that is told to stop after 1 s, read every 10 ms by an encoder's steps.
std::vector<Rolled> stop_of(double speed_mps, double deceleration_mps2, double dead_s, double lag_s = 0.0) {
  constexpr double kTickS = 0.001, kCountM = 2.0 * 3.14159265358979 * 0.1 / 16384.0;
  std::vector<Rolled> track;
  double way_m = 0.0, v = speed_mps;
  for (int i = 0; i < 8000; ++i) {
    if (i * kTickS >= 1.0 + dead_s) {
      const double follow = lag_s > 0.0 ? v * kTickS / lag_s : v;
      v = std::max(0.0, v - std::min(follow, deceleration_mps2 * kTickS));
    }
    way_m += v * kTickS;
    if (i % 10 == 0)
      track.push_back({stamp_from_seconds(100.0 + i * kTickS), kCountM * std::floor(way_m / kCountM)});
  }
  return track;
}

const Stamp kTold = stamp_from_seconds(101.0);

TEST(MeasuredStop, TellsDecelerationAndLatencyOfEveryVehicle) {
  for (const double speed : {0.3, 0.8, 1.0, 1.5})
    for (const double deceleration : {0.5, 0.8, 1.5})
      for (const double dead : {0.05, 0.25, 0.4}) {
        const auto stop = measure_stop(stop_of(speed, deceleration, dead), kTold);
        ASSERT_TRUE(stop) << speed << ' ' << deceleration << ' ' << dead;
        EXPECT_NEAR(stop->speed_mps, speed, 0.005);
        EXPECT_NEAR(stop->deceleration_mps2, deceleration, 0.05 * deceleration);
        EXPECT_NEAR(stop->latency_s, dead, 0.02) << speed << ' ' << deceleration;
      }
}

TEST(MeasuredStop, ALaggingMotorNeedsNoMoreThanTheTwoNumbersSay) {
  const auto track = stop_of(1.0, 1.0, 0.1, 0.1);
  const auto stop = measure_stop(track, kTold);
  ASSERT_TRUE(stop);
  const double foreseen_m =
      stop->speed_mps * stop->latency_s + stop->speed_mps * stop->speed_mps / 2.0 / stop->deceleration_mps2;
  EXPECT_NEAR(foreseen_m, stop->way_m, 0.005);
  EXPECT_GT(stop->latency_s, 0.1) << "the lag is counted with it";
}

TEST(MeasuredStop, NothingIsMeasuredOfWhatIsNoStop) {
  auto track = stop_of(1.0, 0.8, 0.25);
  EXPECT_FALSE(measure_stop({}, kTold));
  EXPECT_FALSE(measure_stop(track, stamp_from_seconds(100.1))) << "no even speed before";
  EXPECT_FALSE(measure_stop(stop_of(0.01, 0.8, 0.25), kTold)) << "it did not drive";
  track.resize(150);
  EXPECT_FALSE(has_stopped(track, 0.3));
  EXPECT_FALSE(measure_stop(track, kTold)) << "it drives still";
}

}  // namespace
}  // namespace madori::control
