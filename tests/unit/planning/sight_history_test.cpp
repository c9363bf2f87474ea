#include "planning/obstacle_check/sight_history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

/// Of a lidar that is mounted aside, seen from there.
TEST(SightHistory, EveryDirectionAndItsNeighboursAreTold) {
  SightHistory sights;
  SensorView view = kVlp;
  view.x_m = 0.7, view.y_m = -0.4;
  for (const double t : {0.0, 0.2}) {
    sights.begin(view, {}, stamp_from_seconds(t));
    for (double deg = 0.0; deg < 360.0; deg += 0.2)
      sights.add(6.0 * std::cos(to_rad(deg)), 6.0 * std::sin(to_rad(deg)), true);
  }
  for (double deg = -180.0; deg <= 180.0; deg += 1.0) {
    const Point2<Odom> near{view.x_m + 3.0 * std::cos(to_rad(deg)), view.y_m + 3.0 * std::sin(to_rad(deg))};
    const Point2<Odom> far{view.x_m + 6.2 * std::cos(to_rad(deg)), view.y_m + 6.2 * std::sin(to_rad(deg))};
    EXPECT_TRUE(sights.was_empty(near, 0.1, 0.1, 1.5, stamp_from_seconds(0.6))) << deg;
    EXPECT_FALSE(sights.was_empty(far, 0.1, 0.1, 1.5, stamp_from_seconds(0.6))) << deg;
  }
}

/// Beside its rays, one by one.
TEST(SensorView, SeesWhatARayOfItsHits) {
  std::mt19937 random(7);
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int seen = 0;
  for (int run = 0; run < 2000; ++run) {
    LidarModel lidar{};
    lidar.mounting = {any(-1.0, 1.0), any(-1.0, 1.0), any(0.2, 2.2), any(-kPi, kPi)};
    lidar.from_rad = any(-kPi, 0.0), lidar.to_rad = any(0.0, kPi);
    lidar.min_elevation_rad = any(-0.5, -0.1), lidar.max_elevation_rad = any(-0.05, 0.4);
    const Point2<Base> place{any(-4.0, 4.0), any(-4.0, 4.0)};
    const double low_m = any(0.0, 1.0), high_m = low_m + any(0.1, 1.0);
    const double x = place.x_m - lidar.mounting.x_m, y = place.y_m - lidar.mounting.y_m;
    const auto hit = [&](double slack_m) {
      for (double bearing = lidar.from_rad; bearing <= lidar.to_rad; bearing += 0.002) {
        const double across_m =
            x * std::sin(bearing + lidar.mounting.yaw_rad) - y * std::cos(bearing + lidar.mounting.yaw_rad);
        const double along_m =
            x * std::cos(bearing + lidar.mounting.yaw_rad) + y * std::sin(bearing + lidar.mounting.yaw_rad);
        if (along_m <= 0.0 || std::abs(across_m) > 0.002 * along_m) continue;
        for (double e = lidar.min_elevation_rad; e <= lidar.max_elevation_rad; e += 0.002) {
          const double height_m = lidar.mounting.z_m + along_m * std::tan(e);
          if (height_m >= low_m - slack_m && height_m <= high_m + slack_m) return true;
        }
      }
      return false;
    };
    const bool sees = SensorView::of(lidar).sees(place, low_m, high_m);
    const double off_rad = std::abs(wrap_angle(std::atan2(y, x) - lidar.mounting.yaw_rad - lidar.from_rad));
    const double past_rad = std::abs(wrap_angle(std::atan2(y, x) - lidar.mounting.yaw_rad - lidar.to_rad));
    const bool at_rim = off_rad < 0.005 || past_rad < 0.005;
    EXPECT_TRUE(sees || at_rim || !hit(-0.04)) << run;
    EXPECT_TRUE(!sees || at_rim || hit(0.02)) << run;
    seen += sees ? 1 : 0;
  }
  EXPECT_GT(seen, 300);
}

}  // namespace
}  // namespace madori::planning
