#include "planning/obstacle_check/sight_history.hpp"

#include <gtest/gtest.h>

#include "core/angle.hpp"
#include "tests/support/toy_lidar.hpp"

namespace madori::planning {
namespace {

using test::kVlp;

/// Scans of a round room of 6 m with a pillar of 0.4 m at (3, 0), every 0.2 s until `end_s`.
SightHistory room(double end_s) {
  SightHistory sights;
  for (double t = 0.0; t < end_s; t += 0.2) {
    EXPECT_TRUE(sights.begin(kVlp, {}, stamp_from_seconds(t)));
    for (double deg = 0.0; deg < 360.0; deg += 0.3) {
      const double angle = to_rad(deg);
      const double away = std::abs(wrap_angle(angle)) < std::atan2(0.2, 3.0) ? 3.0 : 6.0;
      sights.add(away * std::cos(angle), away * std::sin(angle), true);
    }
  }
  return sights;
}

TEST(SightHistory, OnlyWhatWasSeenThroughWasEmpty) {
  const auto sights = room(1.0);
  const auto empty = [&](double x, double y) {
    return sights.was_empty({x, y}, 0.1, 0.1, 1.5, stamp_from_seconds(1.1));
  };
  EXPECT_TRUE(empty(2.0, 0.0)) << "before the pillar";
  EXPECT_TRUE(empty(-4.0, 2.0));
  EXPECT_FALSE(empty(2.9, 0.0)) << "at the pillar";
  EXPECT_FALSE(empty(4.5, 0.0)) << "behind it";
  EXPECT_FALSE(empty(0.0, 5.9)) << "at the wall";
  EXPECT_FALSE(empty(0.0, 8.0)) << "behind the wall";
}

TEST(SightHistory, WhatNoBeamWouldHitIsNotKnownToBeEmpty) {
  const auto sights = room(1.0);
  EXPECT_FALSE(sights.was_empty({1.5, 0.0}, 0.1, 0.1, 0.2, stamp_from_seconds(1.1)))
      << "below the lowest beam";
  EXPECT_TRUE(sights.was_empty({4.5, 1.5}, 0.1, 0.1, 0.2, stamp_from_seconds(1.1)))
      << "further away it reaches so low";
}

TEST(SightHistory, OneScanIsNotEnoughAndOldOnesAreForgotten) {
  EXPECT_FALSE(room(0.1).was_empty({2.0, 0.0}, 0.1, 0.1, 1.5, stamp_from_seconds(1.0)));
  auto sights = room(1.0);
  EXPECT_FALSE(sights.was_empty({2.0, 0.0}, 0.1, 0.1, 1.5, stamp_from_seconds(0.3)))
      << "nothing is old enough to be asked";
  sights.begin(kVlp, {}, stamp_from_seconds(9.0));
  EXPECT_FALSE(sights.was_empty({2.0, 0.0}, 0.1, 0.1, 1.5, stamp_from_seconds(9.5)));
}

TEST(SightHistory, EachSensorIsRememberedForItselfThoughTheirScansComeInNoOrder) {
  SensorView left = kVlp, right = kVlp;
  left.facing_rad = to_rad(90.0), right.facing_rad = to_rad(-90.0);
  left.half_view_rad = right.half_view_rad = to_rad(80.0);
  SightHistory sights;
  for (int i = 0; i < 30; ++i)
    for (const SensorView& view : {left, right}) {  // the right one's scans are older than the left one's
      if (!sights.begin(view, {}, stamp_from_seconds(0.04 * i - (view == right ? 0.01 : 0.0)))) continue;
      for (double deg = -80.0; deg <= 80.0; deg += 0.3)
        sights.add(6.0 * std::cos(view.facing_rad + to_rad(deg)),
                   6.0 * std::sin(view.facing_rad + to_rad(deg)), true);
    }
  EXPECT_TRUE(sights.was_empty({0.0, 3.0}, 0.1, 0.1, 1.5, stamp_from_seconds(1.2)));
  EXPECT_TRUE(sights.was_empty({0.0, -3.0}, 0.1, 0.1, 1.5, stamp_from_seconds(1.2)));
  EXPECT_FALSE(sights.was_empty({3.0, 0.0}, 0.1, 0.1, 1.5, stamp_from_seconds(1.2))) << "nobody looks there";
}

TEST(SightHistory, EveryDirectionAndItsNeighboursAreTold) {
  SightHistory sights;
  for (const double t : {0.0, 0.2}) {
    sights.begin(kVlp, {}, stamp_from_seconds(t));
    for (double deg = 0.0; deg < 360.0; deg += 0.2)
      sights.add(6.0 * std::cos(to_rad(deg)), 6.0 * std::sin(to_rad(deg)), true);
  }
  for (double deg = -180.0; deg <= 180.0; deg += 1.0) {
    const Point2<Odom> near{3.0 * std::cos(to_rad(deg)), 3.0 * std::sin(to_rad(deg))};
    const Point2<Odom> far{6.2 * std::cos(to_rad(deg)), 6.2 * std::sin(to_rad(deg))};
    EXPECT_TRUE(sights.was_empty(near, 0.1, 0.1, 1.5, stamp_from_seconds(0.6))) << deg;
    EXPECT_FALSE(sights.was_empty(far, 0.1, 0.1, 1.5, stamp_from_seconds(0.6))) << deg;
  }
}

}  // namespace
}  // namespace madori::planning
