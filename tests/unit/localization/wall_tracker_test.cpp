#include "localization/wall_tracker/wall_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "localization/wall_extraction/wall_extraction.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

using test::ten_hertz;

std::vector<test::DriveMoment> drive(const mapping::Walls& walls, const std::vector<Point2<Map>>& stops,
                                     const test::DriveSettings& settings, unsigned seed) {
  std::mt19937 engine(seed);
  return test::drive(walls, stops, settings, engine);
}

PoseEstimate take(WallTracker& tracker, const test::DriveMoment& moment) {
  (void)tracker.on_odometry(moment.odometry);
  return tracker.on_scan(moment.scan.stamp, extract_walls(moment.scan, {}));
}

double off_m(const Pose& a, const Pose& b) {
  return distance_m(a.translation(), b.translation());
}

const std::vector<Point2<Map>> kWay{{18.0, 3.0}, {18.0, 21.0}, {38.0, 21.0}, {38.0, 5.0}};

/// The moments of a drive that goes on elsewhere: stamps and wheels run through, the truth jumps.
std::vector<test::DriveMoment> joined(std::vector<test::DriveMoment> a,
                                      const std::vector<test::DriveMoment>& b) {
  const OdometryReading end = a.back().odometry;
  for (test::DriveMoment m : b) {
    m.odometry.stamp = m.scan.stamp =
        end.stamp + (m.odometry.stamp - b.front().odometry.stamp) + std::chrono::milliseconds(100);
    m.odometry.odom_from_base =
        end.odom_from_base * Transform2<Base, Base>(m.odometry.odom_from_base.x_m(),
                                                    m.odometry.odom_from_base.y_m(),
                                                    m.odometry.odom_from_base.yaw_rad());
    a.push_back(std::move(m));
  }
  return a;
}

TEST(WallTracker, FindsItsPlaceStaysOnItAndLearnsTheWheels) {
  const mapping::Walls walls = test::factory_floor();
  auto settings = ten_hertz();
  settings.bias_rad_per_m = 0.01;
  settings.bias_distance = 0.01;
  WallTracker tracker(walls);
  double square = 0.0;
  int count = 0;
  for (const auto& moment : drive(walls, kWay, settings, 3)) {
    const PoseEstimate e = take(tracker, moment);
    if (++count <= 3) continue;
    ASSERT_EQ(e.health.state, LocalizationState::Localized) << count << ": " << e.health.reason;
    square += std::pow(off_m(e.map_from_base, moment.truth), 2);
    EXPECT_LT(off_m(e.map_from_base, moment.truth), 0.05);
    EXPECT_GT(e.covariance(0, 0), 0.0);
  }
  EXPECT_LT(std::sqrt(square / count), 0.012);
  // The wheels report 1 % too much way and too much turn: taken back.
  EXPECT_NEAR(tracker.odometry_model().systematic()[1], -0.01, 0.003);
  EXPECT_NEAR(tracker.odometry_model().systematic()[2], -0.01, 0.003);
}

TEST(WallTracker, BetweenScansTheWheelsCarryThePose) {
  const mapping::Walls walls = test::factory_floor();
  auto settings = ten_hertz();
  settings.steps_per_scan = 5;
  WallTracker tracker(walls);
  int scans = 0;
  for (const auto& moment : drive(walls, kWay, settings, 4)) {
    PoseEstimate e = tracker.on_odometry(moment.odometry);
    if (moment.has_scan) {
      e = tracker.on_scan(moment.scan.stamp, extract_walls(moment.scan, {}));
      ++scans;
    }
    if (scans > 3) {
      EXPECT_LT(off_m(e.map_from_base, moment.truth), 0.06);
      EXPECT_EQ(e.stamp, moment.odometry.stamp);
    }
  }
}

TEST(WallTracker, TheSameReadingsGiveTheSamePosesBitForBit) {
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = drive(walls, {{1.5, 1.2}, {4.5, 1.2}}, ten_hertz(), 5);
  WallTracker first(walls);
  WallTracker second(walls);
  for (const auto& moment : moments) {
    const PoseEstimate a = take(first, moment);
    const PoseEstimate b = take(second, moment);
    ASSERT_EQ(a.map_from_base.x_m(), b.map_from_base.x_m());
    ASSERT_EQ(a.map_from_base.yaw_rad(), b.map_from_base.yaw_rad());
    ASSERT_EQ(a.covariance, b.covariance);
  }
}

TEST(WallTracker, AKidnappingIsNoticedWithinTwoSecondsAndMended) {
  const mapping::Walls walls = test::factory_floor();
  // By a metre ahead, by a metre aside, and into other aisles, some of which look alike.
  const std::vector<std::vector<Point2<Map>>> places{
      {{18.0, 10.1}, {18.0, 12.6}}, {{19.1, 12.6}, {19.1, 15.1}}, {{38.0, 9.0}, {38.0, 11.5}},
      {{60.0, 22.0}, {60.0, 24.5}}, {{50.0, 30.0}, {50.0, 27.5}}, {{18.0, 44.0}, {18.0, 41.5}}};
  auto moments = drive(walls, {{18.0, 6.5}, {18.0, 9.0}}, ten_hertz(), 6);
  WallTracker tracker(walls);
  for (const auto& moment : moments) (void)take(tracker, moment);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t begin = moments.size();
    moments = joined(moments, drive(walls, places[i], ten_hertz(), 7 + static_cast<unsigned>(i)));
    std::size_t lost_after = 1000;
    PoseEstimate e;
    for (std::size_t k = begin; k < moments.size(); ++k) {
      e = take(tracker, moments[k]);
      if (e.health.state == LocalizationState::Lost) lost_after = std::min(lost_after, k - begin);
    }
    EXPECT_LE(lost_after, 20U) << "place " << i;
    EXPECT_EQ(e.health.state, LocalizationState::Localized) << "place " << i << ": " << e.health.reason;
    EXPECT_LT(off_m(e.map_from_base, moments.back().truth), 0.05) << "place " << i;
  }
}

/// Two rooms drawn alike, side by side, each with a door to the same passage.
mapping::Walls twin_rooms() {
  mapping::Walls walls;
  test::add_box(walls, 0.0, 0.0, 16.0, 10.0);
  for (const double x : {0.0, 8.0}) {
    test::add_wall(walls, x + 8.0, 0.0, x + 8.0, 7.0);
    test::add_wall(walls, x, 7.0, x + 3.4, 7.0);
    test::add_wall(walls, x + 4.6, 7.0, x + 8.0, 7.0);
  }
  return walls;
}

TEST(WallTracker, ACarryIntoARoomThatIsDrawnAlikeIsNoticedByWhatStandsThere) {
  const mapping::Walls drawn = twin_rooms();
  mapping::Walls built = drawn;
  test::add_box(built, 0.5, 5.0, 1.5, 6.5);  // what nobody drew: a cupboard here, pallets there
  test::add_box(built, 13.0, 0.4, 14.5, 1.2);
  auto moments = drive(built, {{3.0, 2.0}, {4.0, 3.5}}, ten_hertz(), 11);
  const std::size_t begin = moments.size();
  moments = joined(moments, drive(built, {{12.0, 3.5}, {12.5, 4.5}}, ten_hertz(), 12));
  WallTracker tracker(drawn);
  (void)tracker.on_odometry(moments[0].odometry);
  tracker.set_pose(moments[0].truth, {});
  for (std::size_t i = 1; i < begin; ++i)
    ASSERT_EQ(take(tracker, moments[i]).health.state, LocalizationState::Localized) << i;
  const PoseEstimate e = take(tracker, moments[begin]);
  EXPECT_EQ(e.health.state, LocalizationState::Lost);
  EXPECT_NE(e.health.reason.find("moved by hand"), std::string::npos) << e.health.reason;
  for (std::size_t i = begin + 1; i < moments.size(); ++i) {
    const PoseEstimate after = take(tracker, moments[i]);
    EXPECT_FALSE(after.health.state == LocalizationState::Localized &&
                 off_m(after.map_from_base, moments[i].truth) > 1.0)
        << "sure of the wrong room";
  }
}

TEST(WallTracker, WhatDrivesPastInFrontOfTheLidarIsNoCarry) {
  const mapping::Walls walls = test::factory_floor();
  std::mt19937 engine(13);
  const auto moments = drive(walls, {{18.0, 6.5}, {18.0, 9.0}}, ten_hertz(), 13);
  WallTracker tracker(walls);
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    mapping::Walls now = walls;  // a lorry of 6 m passes at 3 m/s, 1.5 m beside the lidar
    const double front_y = 5.0 + 0.3 * static_cast<double>(i);
    test::add_box(now, 19.5, front_y - 6.0, 21.5, front_y);
    test::DriveMoment moment = moments[i];
    moment.scan = test::simulate_scan(now, moment.truth, ten_hertz().lidar, engine);
    moment.scan.stamp = moments[i].scan.stamp;
    const PoseEstimate e = take(tracker, moment);
    hidden += tracker.evidence().explained < 0.8;
    if (i > 3) {
      EXPECT_EQ(e.health.state, LocalizationState::Localized) << i << ": " << e.health.reason;
    }
  }
  EXPECT_GT(hidden, 5U) << "it hid next to nothing: no test";
}

TEST(WallTracker, BetweenRacksThatAreNotDrawnTheWheelsCarryTheVehicleOn) {
  const mapping::Walls drawn = test::laboratory_hall();
  mapping::Walls real = drawn;
  for (double x = 6.0; x < 11.5; x += 0.5) {  // boxes that stand askew on both sides of the way
    test::add_wall(real, x, 0.1, x + 0.25, 0.6);
    test::add_wall(real, x + 0.25, 0.6, x + 0.5, 0.1);
    test::add_wall(real, x, 2.2, x + 0.25, 1.8);
    test::add_wall(real, x + 0.25, 1.8, x + 0.5, 2.2);
  }
  const auto moments = drive(real, {{1.5, 1.2}, {16.0, 1.2}}, ten_hertz(), 7);
  for (const bool by_wheels : {true, false}) {
    WallTrackerOptions options;
    if (!by_wheels) options.wheels_alone_m = 0.0;
    WallTracker tracker(drawn, options);
    int count = 0, lost = 0, degraded = 0;
    std::string why;
    for (const auto& moment : moments) {
      const PoseEstimate e = take(tracker, moment);
      if (++count <= 3) continue;
      if (lost == 0) why = e.health.reason;
      lost += e.health.state != LocalizationState::Localized && e.health.state != LocalizationState::Degraded;
      degraded += e.health.state == LocalizationState::Degraded;
      if (by_wheels) {
        EXPECT_LT(off_m(e.map_from_base, moment.truth), 0.1);
      }
    }
    EXPECT_GT(degraded, 0);
    EXPECT_EQ(lost > 0, !by_wheels) << lost << why;
  }
}

TEST(WallTracker, APlaceThatAPersonGivesIsCheckedByTheNextScan) {
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = drive(walls, {{1.5, 1.2}, {4.5, 1.2}}, ten_hertz(), 8);
  WallTracker tracker(walls);
  (void)tracker.on_odometry(moments[0].odometry);
  const Pose& truth = moments[0].truth;
  tracker.set_pose({truth.x_m() + 0.6, truth.y_m() - 0.3, truth.yaw_rad() + 0.15}, {});
  ASSERT_EQ(tracker.hypotheses().size(), 1U);
  EXPECT_NEAR(tracker.hypotheses()[0].map_from_base.x_m(), truth.x_m() + 0.6, 1e-9);
  const PoseEstimate e = take(tracker, moments[1]);
  EXPECT_EQ(e.health.state, LocalizationState::Localized) << e.health.reason;
  EXPECT_LT(off_m(e.map_from_base, moments[1].truth), 0.05);

  tracker.set_pose({15.0, 4.0, 2.0}, {});
  const PoseEstimate wrong = take(tracker, moments[2]);
  EXPECT_NE(wrong.health.state, LocalizationState::Localized);
  EXPECT_NE(wrong.health.reason.find("given"), std::string::npos) << wrong.health.reason;
  PoseEstimate found;
  for (std::size_t i = 3; i < 7; ++i) found = take(tracker, moments[i]);
  EXPECT_EQ(found.health.state, LocalizationState::Localized) << found.health.reason;
  EXPECT_LT(off_m(found.map_from_base, moments[6].truth), 0.05);
}

TEST(WallTracker, NamesItsHypothesesWhileItSearches) {
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = drive(walls, {{1.5, 1.2}, {4.5, 1.2}}, ten_hertz(), 9);
  WallTracker tracker(walls);
  EXPECT_TRUE(tracker.hypotheses().empty());
  for (std::size_t i = 0; i < 4; ++i) (void)take(tracker, moments[i]);
  tracker.search_anew();
  EXPECT_EQ(tracker.on_odometry(moments[4].odometry).health.state, LocalizationState::Lost);
  const PoseEstimate e = take(tracker, moments[5]);
  EXPECT_NE(e.health.state, LocalizationState::Localized) << "one sighting is not enough";
  const auto places = tracker.hypotheses();
  ASSERT_FALSE(places.empty());
  double sum = 0.0;
  for (const auto& place : places) sum += place.probability;
  EXPECT_LE(sum, 1.0 + 1e-9);
  EXPECT_LT(off_m(places.front().map_from_base, moments[5].truth), 0.1);
  EXPECT_GT(places.front().explained, 0.5);
}

TEST(WallTracker, EmptyScansLateOnesAndBrokenReadingsDoNoHarm) {
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = drive(walls, {{1.5, 1.2}, {5.5, 1.2}}, ten_hertz(), 10);
  WallTracker tracker(walls);
  (void)tracker.on_scan(moments[0].scan.stamp, {});
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const PoseEstimate e = take(tracker, moments[i]);
    (void)tracker.on_scan(moments[0].scan.stamp, extract_walls(moments[0].scan, {}));
    (void)tracker.on_odometry(moments[0].odometry);
    (void)tracker.on_odometry({moments[i].odometry.stamp, {std::nan(""), 0.0, 0.0}});
    if (i % 3 == 0) (void)tracker.on_scan(moments[i].scan.stamp, {});
    if (i > 3) {
      EXPECT_LT(off_m(e.map_from_base, moments[i].truth), 0.05) << i;
    }
  }
}

}  // namespace
}  // namespace madori::localization
