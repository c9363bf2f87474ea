#include "localization/localizer/localizer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"

namespace madori::localization {
namespace {

const std::vector<Point2<Map>> kRoundAndOn{{2.0, 1.2},  {7.0, 1.2},  {11.0, 1.2}, {14.5, 1.0}, {14.4, 4.5},
                                           {14.0, 8.0}, {10.2, 7.6}, {7.2, 7.6},  {7.0, 4.0},  {6.8, 1.3},
                                           {11.0, 1.2}, {14.5, 1.0}, {14.4, 4.5}};

struct Errors {
  double rms_m = 0.0;
  double last_m = 0.0;
  double last_rad = 0.0;
};

/// Errors over the second half of the drive.
Errors run(Localizer& localizer, const std::vector<test::DriveMoment>& moments) {
  Errors errors;
  double squares = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    PoseEstimate e = localizer.on_odometry(moments[i].odometry);
    if (moments[i].has_scan) e = localizer.on_scan(moments[i].scan.stamp, scan_points(moments[i].scan, {}));
    errors.last_m = distance_m(e.map_from_base.translation(), moments[i].truth.translation());
    errors.last_rad = std::abs(wrap_angle(e.map_from_base.yaw_rad() - moments[i].truth.yaw_rad()));
    if (2 * i > moments.size()) {
      squares += errors.last_m * errors.last_m;
      ++count;
    }
  }
  errors.rms_m = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, count)));
  return errors;
}

test::DriveSettings bad_wheels() {
  test::DriveSettings settings;
  settings.bias_rad_per_m = 0.05;
  settings.bias_distance = 0.03;
  settings.lidar.range_sigma_m = 0.015;
  return settings;
}

TEST(Localizer, FindsItsPlaceOnAnExactDrawingFromARoughStart) {
  std::mt19937 engine(11);
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = test::drive(walls, kRoundAndOn, bad_wheels(), engine);
  const Transform2<Map, Base> truth = moments.front().truth;
  Localizer localizer(walls,
                      InitialPose{{truth.x_m() + 0.4, truth.y_m() - 0.3, truth.yaw_rad() + to_rad(10.0)}});
  const Errors errors = run(localizer, moments);
  EXPECT_LT(errors.rms_m, 0.05);
  EXPECT_LT(errors.last_rad, to_rad(0.5));
}

TEST(Localizer, FollowsTheBuildingWhereTheDrawingIsWrong) {
  std::mt19937 engine(12);
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = test::drive(walls, kRoundAndOn, bad_wheels(), engine);
  mapping::Walls drawing = walls;
  for (std::size_t i = 10; i < 18; ++i) {  // the machines stand half a metre beside where they are drawn
    drawing[i].segment.a.x_m += 0.5;
    drawing[i].segment.b.x_m += 0.5;
  }
  Localizer localizer(drawing, InitialPose{moments.front().truth});
  EXPECT_LT(run(localizer, moments).rms_m, 0.12);
}

TEST(Localizer, MapsWithoutADrawing) {
  std::mt19937 engine(13);
  const auto moments = test::drive(test::laboratory_hall(), kRoundAndOn, bad_wheels(), engine);
  Localizer localizer({}, InitialPose{moments.front().truth});
  const Errors errors = run(localizer, moments);
  EXPECT_LT(errors.rms_m, 0.10);
  EXPECT_GT(localizer.memory().loops(), 0);
}

TEST(Localizer, TheSameReadingsGiveTheSamePosesBitForBit) {
  std::mt19937 engine(14);
  const mapping::Walls walls = test::laboratory_hall();
  auto moments = test::drive(walls, kRoundAndOn, bad_wheels(), engine);
  moments.resize(150);
  Localizer a(walls, InitialPose{moments.front().truth}), b(walls, InitialPose{moments.front().truth});
  for (const auto& m : moments) {
    (void)a.on_odometry(m.odometry);
    (void)b.on_odometry(m.odometry);
    if (!m.has_scan) continue;
    const PoseEstimate pa = a.on_scan(m.scan.stamp, scan_points(m.scan, {}));
    const PoseEstimate pb = b.on_scan(m.scan.stamp, scan_points(m.scan, {}));
    ASSERT_EQ(pa.map_from_base.x_m(), pb.map_from_base.x_m());
    ASSERT_EQ(pa.map_from_base.yaw_rad(), pb.map_from_base.yaw_rad());
  }
}

TEST(Localizer, WhereThinkingIsNotWaitedForTheSameWordsGiveTheSamePoses) {
  std::mt19937 engine(14);
  const mapping::Walls walls = test::laboratory_hall();
  auto moments = test::drive(walls, kRoundAndOn, bad_wheels(), engine);
  moments.resize(300);
  const InitialPose begin{moments.front().truth};
  Localizer live(walls, begin), again(walls, begin), waiting(walls, begin);
  int unfinished = 0, otherwise = 0;
  for (const auto& m : moments) {
    for (Localizer* l : {&live, &again, &waiting}) (void)l->on_odometry(m.odometry);
    if (!m.has_scan) continue;
    const bool thinking = live.is_thinking();  // the scans come faster than thoughts: nothing holds them up
    unfinished += thinking ? 1 : 0;
    live.set_thinking(thinking);
    again.set_thinking(thinking);
    const ScanPoints points = scan_points(m.scan, {});
    const auto pose = live.on_scan(m.scan.stamp, points).map_from_base;
    const auto same = again.on_scan(m.scan.stamp, points).map_from_base;
    ASSERT_EQ(pose.x_m(), same.x_m());
    ASSERT_EQ(pose.yaw_rad(), same.yaw_rad());
    otherwise += waiting.on_scan(m.scan.stamp, points).map_from_base.x_m() != pose.x_m() ? 1 : 0;
  }
  EXPECT_GT(unfinished, 0);
  EXPECT_GT(otherwise, 0);
}

TEST(Localizer, SurvivesEmptyScansAndLateReadings) {
  std::mt19937 engine(15);
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = test::drive(walls, kRoundAndOn, bad_wheels(), engine);
  Localizer localizer(walls, InitialPose{moments.front().truth});
  for (std::size_t i = 0; i < moments.size(); ++i) {
    (void)localizer.on_odometry(moments[i].odometry);
    if (i > 0 && i % 7 == 0) (void)localizer.on_odometry(moments[i - 1].odometry);
    if (i % 11 == 0) (void)localizer.on_scan(moments[i].odometry.stamp, ScanPoints{});
    if (i % 17 == 0) (void)localizer.on_odometry({moments[i].odometry.stamp, {std::nan(""), 0.0, 0.0}});
    if (moments[i].has_scan && i % 9 != 0) {
      (void)localizer.on_scan(moments[i].scan.stamp, scan_points(moments[i].scan, {}));
    }
  }
  const PoseEstimate last = localizer.on_odometry(moments.back().odometry);
  EXPECT_LT(distance_m(last.map_from_base.translation(), moments.back().truth.translation()), 0.15);
}

PoseEstimate feed(Localizer& localizer, const test::DriveMoment& m) {
  const PoseEstimate e = localizer.on_odometry(m.odometry);
  return m.has_scan ? localizer.on_scan(m.scan.stamp, scan_points(m.scan, {})) : e;
}

TEST(Localizer, FindsItsPlaceWithoutAStartPose) {
  std::mt19937 engine(16);
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = test::drive(walls, kRoundAndOn, bad_wheels(), engine);
  Localizer localizer(walls, std::nullopt);
  const Errors errors = run(localizer, moments);
  EXPECT_LT(errors.rms_m, 0.05);
  EXPECT_EQ(feed(localizer, moments.back()).health.state, LocalizationState::Localized);
}

TEST(Localizer, AMirroredDrawingIsNeverBelieved) {
  std::mt19937 engine(17);
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = test::drive(walls, kRoundAndOn, bad_wheels(), engine);
  mapping::Walls mirrored = walls;
  for (auto& wall : mirrored) {
    wall.segment.a.x_m = 20.0 - wall.segment.a.x_m;
    wall.segment.b.x_m = 20.0 - wall.segment.b.x_m;
  }
  Localizer localizer(mirrored, InitialPose{moments.front().truth});
  std::size_t believed = 0;
  PoseEstimate last;
  for (const auto& m : moments) {
    last = feed(localizer, m);
    believed += last.health.state == LocalizationState::Localized ? 1 : 0;
  }
  EXPECT_EQ(last.health.state, LocalizationState::Lost) << last.health.reason;
  EXPECT_LT(20 * believed, moments.size());
}

TEST(Localizer, AKidnappingIsNoticedWithinTwoSecondsAndMended) {
  std::mt19937 engine(18);
  const mapping::Walls walls = test::laboratory_hall();
  const auto before = test::drive(walls, {{2.0, 1.2}, {7.0, 1.2}, {11.0, 1.2}}, bad_wheels(), engine);
  auto after = test::drive(walls, {{14.4, 8.6}, {14.0, 4.5}, {14.5, 1.0}, {11.0, 1.2}, {7.0, 1.2}},
                           bad_wheels(), engine);
  Localizer localizer(walls, InitialPose{before.front().truth});
  PoseEstimate last;
  for (const auto& m : before) last = feed(localizer, m);
  ASSERT_EQ(last.health.state, LocalizationState::Localized) << last.health.reason;
  const OdometryReading carried_on = before.back().odometry;  // the wheels feel nothing of the lift
  const Transform2<Odom, Odom> shift =
      carried_on.odom_from_base * after.front().odometry.odom_from_base.inverse();
  double noticed_s = 1e9;
  for (auto& m : after) {
    const Duration later = carried_on.stamp - after.front().odometry.stamp + std::chrono::milliseconds(100);
    test::DriveMoment now = m;
    now.odometry = {m.odometry.stamp + later, shift * m.odometry.odom_from_base};
    now.scan.stamp = now.odometry.stamp;
    last = feed(localizer, now);
    if (last.health.state == LocalizationState::Lost) {
      noticed_s = std::min(noticed_s, to_seconds(now.odometry.stamp - carried_on.stamp));
    }
  }
  EXPECT_LT(noticed_s, 2.0);
  EXPECT_EQ(last.health.state, LocalizationState::Localized) << last.health.reason;
  EXPECT_LT(distance_m(last.map_from_base.translation(), after.back().truth.translation()), 0.2);
}

/// A hall of the drawing, and behind a door a workshop that is not drawn.
mapping::Walls with_an_undrawn_workshop(std::size_t& drawn) {
  mapping::Walls walls;
  test::add_wall(walls, 0.0, 0.0, 12.0, 0.0);
  test::add_wall(walls, 12.0, 0.0, 12.0, 3.0);
  test::add_wall(walls, 12.0, 4.2, 12.0, 8.0);
  test::add_wall(walls, 12.0, 8.0, 0.0, 8.0);
  test::add_wall(walls, 0.0, 8.0, 0.0, 0.0);
  test::add_box(walls, 3.0, 2.2, 5.4, 3.6);
  test::add_box(walls, 7.5, 5.0, 8.7, 6.9);
  drawn = walls.size();
  test::add_wall(walls, 12.0, -3.0, 22.0, -3.0);
  test::add_wall(walls, 22.0, -3.0, 22.0, 10.0);
  test::add_wall(walls, 22.0, 10.0, 12.0, 10.0);
  test::add_wall(walls, 12.0, 10.0, 12.0, 8.0);
  test::add_wall(walls, 12.0, 0.0, 12.0, -3.0);
  test::add_box(walls, 15.0, 5.5, 16.4, 8.0);
  test::add_box(walls, 18.0, -1.5, 20.5, 0.5);
  return walls;
}

TEST(Localizer, WheelsThatSlipInAnUndrawnRoomAreNoKidnapping) {
  std::mt19937 engine(21);
  std::size_t drawn = 0;
  const mapping::Walls walls = with_an_undrawn_workshop(drawn);
  const mapping::Walls drawing(walls.begin(), walls.begin() + static_cast<long>(drawn));
  const std::vector<Point2<Map>> round{{2.0, 1.2},  {10.5, 1.2}, {10.5, 3.6}, {14.0, 3.6}, {14.0, -1.5},
                                       {14.0, 3.6}, {20.0, 3.6}, {20.0, 8.5}, {20.0, 3.6}, {10.5, 3.6},
                                       {10.5, 7.4}, {2.0, 7.4},  {1.5, 1.2},  {10.5, 1.2}, {10.5, 3.6},
                                       {20.0, 3.6}, {20.0, 8.5}, {20.0, 3.6}, {14.0, 3.6}, {14.0, -1.5}};
  auto moments = test::drive(walls, round, bad_wheels(), engine);
  const std::size_t slip = moments.size() - 120;
  ASSERT_GT(moments[slip].truth.x_m(), 15.0);
  Localizer localizer(drawing, InitialPose{moments.front().truth});
  const Transform2<Odom, Base> held = moments[slip].odometry.odom_from_base;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (i > slip) {  // half a metre and 20 degrees that were none
      moments[i].odometry.odom_from_base = held * Transform2<Base, Base>(0.5, 0.1, to_rad(20.0)) *
                                           (held.inverse() * moments[i].odometry.odom_from_base);
    }
    const PoseEstimate e = feed(localizer, moments[i]);
    if (i > 20) {  // until the first look at the drawing nobody knows
      EXPECT_NE(e.health.state, LocalizationState::Lost) << i << " of " << slip << ": " << e.health.reason;
    }
    if (i > slip + 10) {
      EXPECT_LT(distance_m(e.map_from_base.translation(), moments[i].truth.translation()), 0.25);
    }
  }
}

TEST(Localizer, AnUndrawnRoomIsDoubtedOnTheFirstWayThroughItOnly) {
  std::mt19937 engine(22);
  std::size_t drawn = 0;
  const mapping::Walls walls = with_an_undrawn_workshop(drawn);
  const mapping::Walls drawing(walls.begin(), walls.begin() + static_cast<long>(drawn));
  const std::vector<Point2<Map>> lap{{2.0, 1.2},  {10.5, 1.2}, {10.5, 3.6}, {20.0, 3.6},
                                     {20.0, 8.5}, {20.0, 3.6}, {14.0, 3.6}, {10.5, 3.6},
                                     {10.5, 7.4}, {2.0, 7.4},  {1.5, 1.2}};
  std::vector<Point2<Map>> laps = lap;
  laps.insert(laps.end(), lap.begin(), lap.end());
  const auto moments = test::drive(walls, laps, bad_wheels(), engine);
  Localizer localizer(drawing, InitialPose{moments.front().truth});
  std::array<std::size_t, 2> doubted{};
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const PoseEstimate e = feed(localizer, moments[i]);
    const bool doubts = e.health.reason.find("much less than usual") != std::string::npos;
    doubted[2 * i < moments.size() ? 0 : 1] += doubts ? 1 : 0;
    EXPECT_LT(distance_m(e.map_from_base.translation(), moments[i].truth.translation()), 0.25);
  }
  EXPECT_GT(doubted[0], 0u);
  EXPECT_EQ(doubted[1], 0u);
}

TEST(Localizer, TheMemoryGrowsWithTheBuildingAndNotWithTheWay) {
  std::mt19937 engine(19);
  const mapping::Walls walls = test::laboratory_hall();
  const std::vector<Point2<Map>> lap{{7.0, 1.2},  {11.0, 1.2}, {14.5, 1.0}, {14.4, 4.5},
                                     {14.0, 8.0}, {10.2, 7.6}, {7.2, 7.6},  {7.0, 4.0}};
  std::vector<Point2<Map>> laps;
  for (int i = 0; i < 8; ++i) laps.insert(laps.end(), lap.begin(), lap.end());
  const auto moments = test::drive(walls, laps, bad_wheels(), engine);
  Localizer localizer(walls, InitialPose{moments.front().truth});
  std::size_t halfway = 0;
  double worst_m = 0.0;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const PoseEstimate e = feed(localizer, moments[i]);
    if (i == moments.size() / 2) halfway = localizer.memory().bytes();
    if (2 * i > moments.size()) {
      worst_m = std::max(worst_m, distance_m(e.map_from_base.translation(), moments[i].truth.translation()));
    }
  }
  EXPECT_LT(static_cast<double>(localizer.memory().bytes()), 1.15 * static_cast<double>(halfway));
  EXPECT_LT(localizer.memory().size(), 200u);  // 200 m of driving with a keyframe every 0.4 m or 14 degrees
  EXPECT_LT(worst_m, 0.15);
}

TEST(Localizer, BeginsInWhatAnEarlierDriveRemembered) {
  std::mt19937 engine(20);
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = test::drive(walls, kRoundAndOn, bad_wheels(), engine);
  Localizer first(walls, InitialPose{moments.front().truth});
  for (const auto& m : moments) (void)feed(first, m);
  const Transform2<Map, Base> truth = moments.front().truth;
  const InitialPose rough{{truth.x_m() + 0.4, truth.y_m() - 0.3, truth.yaw_rad() + to_rad(8.0)}};
  Localizer second(walls, rough);
  second.recall(first.finished_memory());
  const PoseEstimate at_once = feed(second, moments.front());
  EXPECT_TRUE(second.has_recalled());
  EXPECT_LT(distance_m(at_once.map_from_base.translation(), truth.translation()), 0.08);
  const Errors errors = run(second, moments);
  EXPECT_LT(errors.rms_m, 0.05);

  Localizer elsewhere(walls, InitialPose{{17.0, 8.5, 2.0}});  // the memory was not made from here
  elsewhere.recall(first.finished_memory());
  (void)feed(elsewhere, moments.front());
  EXPECT_FALSE(elsewhere.has_recalled());
}

}  // namespace
}  // namespace madori::localization
