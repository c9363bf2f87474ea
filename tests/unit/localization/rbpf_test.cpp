#include <gtest/gtest.h>

#include <random>

#include "localization/particle_filter/resampling.hpp"
#include "localization/slam/grid_match.hpp"
#include "localization/slam/rbpf_mapper.hpp"
#include "localization/slam/surface_grid.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"
#include "tests/support/scan_at.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

using test::scan_at;

/// What is drawn i-th comes floor or ceil of count * weight times, and on average exactly so often.
TEST(SystematicDraw, TakesEveryoneByHisWeight) {
  const std::vector<double> weights{0.05, 0.4, 0.0, 0.25, 0.3};
  constexpr std::size_t kCount = 7;
  std::vector<double> sums(weights.size(), 0.0);
  constexpr int kOffsets = 1000;
  for (int o = 0; o < kOffsets; ++o) {
    std::vector<int> taken(weights.size(), 0);
    draw_systematically(weights, kCount, (o + 0.5) / kOffsets, [&](std::size_t i) { ++taken[i]; });
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_GE(taken[i], static_cast<int>(std::floor(kCount * weights[i])));
      EXPECT_LE(taken[i], static_cast<int>(std::ceil(kCount * weights[i])));
      sums[i] += static_cast<double>(taken[i]) / kOffsets;
    }
  }
  for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(sums[i], kCount * weights[i], 0.01);
}

TEST(SurfaceGrid, CopiesShareUntilOneChanges) {
  std::mt19937 engine(5);
  const mapping::Walls walls = test::laboratory_hall();
  SurfaceGrid first;
  first.add(scan_at(walls, {6.0, 1.2, 0.0}, engine), {6.0, 1.2, 0.0});
  const SurfaceGrid kept = first;
  SurfaceGrid::Surface before, after;
  const SurfacePoint wall{6.0, 0.02, 0.0, 1.0}, beside{6.0, -0.15, 0.0, 1.0};
  ASSERT_TRUE(kept.nearest(wall, 1, before));
  ASSERT_FALSE(kept.nearest(beside, 0, after));
  for (int i = 0; i < 5; ++i) first.add(scan_at(walls, {6.0, 1.2, 0.0}, engine), {6.0, 1.05, 0.0});
  EXPECT_TRUE(first.nearest(beside, 0, after));
  EXPECT_FALSE(kept.nearest(beside, 0, after));
  ASSERT_TRUE(kept.nearest(wall, 1, after));
  EXPECT_EQ(before.y_m, after.y_m);
  EXPECT_EQ(kept.content(6.0, 0.6), SurfaceGrid::Content::Free);
  EXPECT_EQ(kept.content(6.0, -5.0), SurfaceGrid::Content::Unknown);
}

TEST(GridMatch, FindsThePoseAndLikesItBest) {
  std::mt19937 engine(6);
  const mapping::Walls walls = test::laboratory_hall();
  SurfaceGrid map;
  for (const Pose& p : {Pose(5.5, 1.2, 0.0), Pose(6.2, 1.3, 0.2), Pose(7.0, 1.2, -0.1)})
    map.add(scan_at(walls, p, engine), p);
  const Pose truth(6.5, 1.25, 0.1);
  const SurfaceScan scan = scan_at(walls, truth, engine);
  const Eigen::Matrix3d loose = Eigen::Vector3d(25.0, 25.0, 100.0).asDiagonal();
  const GridMatch match = match_to_grid(scan, map, {6.6, 1.17, 0.06}, {Pose(6.6, 1.17, 0.06), loose});
  EXPECT_LT(distance_m(match.map_from_base.translation(), truth.translation()), 0.02);
  EXPECT_NEAR(match.map_from_base.yaw_rad(), truth.yaw_rad(), 0.005);
  EXPECT_GT(match.inlier_share, 0.7);
  const double right = log_likelihood(scan, map, truth, 12.0);
  EXPECT_GT(right, log_likelihood(scan, map, {6.65, 1.25, 0.1}, 12.0) + 1.0);
  EXPECT_GT(right, log_likelihood(scan, map, {6.5, 1.25, 0.2}, 12.0) + 1.0);
}

TEST(RbpfMapper, MapsAHallWithBadWheelsAndRepeatsItself) {
  std::mt19937 engine(7);
  test::DriveSettings settings;
  settings.lidar = test::ScanSettings{};
  settings.bias_rad_per_m = 0.03;
  settings.sigma_distance = 0.03;
  const auto moments = test::drive(test::laboratory_hall(), test::kTwoRounds, settings, engine);
  std::vector<Pose> truth;
  for (const auto& moment : moments)
    if (moment.has_scan) truth.push_back(moment.truth);
  bool all_alike_again = false;  // resampling makes the weights alike
  const auto drive = [&](std::uint32_t seed) {
    RbpfOptions options;
    options.particles = 10;
    options.seed = seed;
    RbpfMapper mapper(options);
    double least = 10.0;
    for (const auto& moment : moments) {
      (void)mapper.on_odometry(moment.odometry);
      if (moment.has_scan) (void)mapper.on_scan(moment.scan.stamp, scan_points(moment.scan, {}), {});
      const double effective = mapper.effective_particles();
      EXPECT_LE(effective, 10.0 + 1e-6);
      all_alike_again = all_alike_again || (least < 9.9 && effective > 10.0 - 1e-6);
      if (moment.has_scan) least = std::min(least, effective);
    }
    return mapper.finish();
  };
  const FinishedMap map = drive(1);
  EXPECT_TRUE(all_alike_again);
  ASSERT_EQ(map.scans.size(), truth.size());
  double worst_m = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto placed = map.scans[0].map_from_base.inverse() * map.scans[i].map_from_base;
    const auto right = truth[0].inverse() * truth[i];
    worst_m = std::max(worst_m, std::hypot(placed.x_m() - right.x_m(), placed.y_m() - right.y_m()));
  }
  EXPECT_LT(worst_m, 0.15);
  const FinishedMap again = drive(1);
  EXPECT_EQ(again.scans.back().map_from_base.x_m(), map.scans.back().map_from_base.x_m());
  EXPECT_NE(drive(2).scans.back().map_from_base.x_m(), map.scans.back().map_from_base.x_m());
}

}  // namespace
}  // namespace madori::localization
