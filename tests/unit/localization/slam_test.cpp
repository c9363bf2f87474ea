#include <gtest/gtest.h>

#include <random>

#include "localization/slam/graph_mapper.hpp"
#include "localization/slam/laid_way.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"

namespace madori::localization {
namespace {

Stamp second(double s) {
  return stamp_from_seconds(s);
}

TEST(LaidWay, MeetsItsAnchorsAndSpreadsTheErrorByTheWay) {
  std::vector<ReckonedPose> way;
  for (int i = 0; i <= 10; ++i) way.push_back({second(i), {0.1 * std::min(i, 8), 0.0, 0.0}});
  const Transform2<Map, Base> start(1.0, 2.0, 0.0);
  const Transform2<Map, Base> end(1.0, 2.9, 0.0);  // the reckoning: 0.8 m along x; truth: 0.9 m along y
  const auto laid = laid_way(way, {{0, start}, {10, end}});
  ASSERT_EQ(laid.size(), way.size());
  EXPECT_NEAR(laid[0].map_from_base.x_m(), 1.0, 1e-9);
  EXPECT_NEAR(laid[10].map_from_base.y_m(), 2.9, 1e-9);
  EXPECT_NEAR(laid[4].map_from_base.y_m(), 2.45, 1e-4);  // half of the way, half of the error
  EXPECT_NEAR(laid[9].map_from_base.y_m(), 2.9, 1e-4);   // it stood: none of the error
}

TEST(LaidWay, CarriesOnBeyondItsAnchors) {
  std::vector<ReckonedPose> way;
  for (int i = 0; i < 5; ++i) way.push_back({second(i), {1.0 * i, 0.0, 0.0}});
  const auto laid = laid_way(way, {{2, {0.0, 0.0, 0.5 * kPi}}});
  EXPECT_NEAR(laid[4].map_from_base.y_m(), 2.0, 1e-9);
  EXPECT_NEAR(laid[0].map_from_base.y_m(), -2.0, 1e-9);
  EXPECT_TRUE(laid_way(way, {}).empty());
}

/// Twice around the laboratory hall.
const std::vector<Point2<Map>> kTwoRounds{{2.5, 1.2},  {11.0, 1.2}, {14.4, 1.0}, {14.4, 4.2}, {14.4, 8.2},
                                          {12.5, 8.2}, {11.0, 7.2}, {7.0, 7.8},  {6.5, 3.8},  {6.5, 1.2},
                                          {2.5, 1.2},  {11.0, 1.2}, {14.4, 1.0}, {14.4, 4.2}};

TEST(GraphMapper, MapsAHallWithBadWheels) {
  std::mt19937 engine(5);
  test::DriveSettings settings;
  settings.lidar = test::ScanSettings{};
  settings.bias_rad_per_m = 0.03;
  settings.sigma_distance = 0.03;
  const auto moments = test::drive(test::laboratory_hall(), kTwoRounds, settings, engine);
  GraphMapper mapper;
  std::vector<Transform2<Map, Base>> truth;
  for (const auto& moment : moments) {
    (void)mapper.on_odometry(moment.odometry);
    if (!moment.has_scan) continue;
    (void)mapper.on_scan(moment.scan.stamp, scan_points(moment.scan, {}), {});
    truth.push_back(moment.truth);
  }
  const FinishedMap map = mapper.finish();
  ASSERT_EQ(map.scans.size(), truth.size());
  EXPECT_EQ(map.lost_scans, 0);
  EXPECT_GT(map.memory.loops(), 3);
  double worst_m = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto placed = map.scans[0].map_from_base.inverse() * map.scans[i].map_from_base;
    const auto right = truth[0].inverse() * truth[i];
    worst_m = std::max(worst_m, std::hypot(placed.x_m() - right.x_m(), placed.y_m() - right.y_m()));
  }
  EXPECT_LT(worst_m, 0.06);
}

TEST(GraphMapper, IsCausalAndRepeatsItself) {
  std::mt19937 engine(6);
  const auto moments =
      test::drive(test::laboratory_hall(), {{2.5, 1.2}, {11.0, 1.2}, {14.4, 1.0}}, {}, engine);
  const auto poses = [&](std::size_t until) {
    GraphMapper mapper;
    std::vector<double> all;
    for (std::size_t i = 0; i < until; ++i) {
      all.push_back(mapper.on_odometry(moments[i].odometry).map_from_base.x_m());
      if (moments[i].has_scan)
        all.push_back(
            mapper.on_scan(moments[i].scan.stamp, scan_points(moments[i].scan, {}), {}).map_from_base.y_m());
    }
    return all;
  };
  const auto whole = poses(moments.size());
  const auto half = poses(moments.size() / 2);
  EXPECT_TRUE(std::equal(half.begin(), half.end(), whole.begin()));
  EXPECT_EQ(whole, poses(moments.size()));
}

TEST(GraphMapper, HasNothingToFinishWithoutAScan) {
  GraphMapper mapper;
  (void)mapper.on_odometry({second(1.0), {}});
  const FinishedMap map = mapper.finish();
  EXPECT_TRUE(map.memory.empty());
  EXPECT_TRUE(map.scans.empty());
}

}  // namespace
}  // namespace madori::localization
