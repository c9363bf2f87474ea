#include "localization/localizability/localizability.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "localization/registration/segment_icp.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

TEST(Localizability, ABareCorridorIsUncertainAlongItself) {
  mapping::Walls corridor;
  test::add_wall(corridor, -100.0, 0.0, 100.0, 0.0);
  test::add_wall(corridor, -100.0, 3.0, 100.0, 3.0);
  const SegmentGrid walls(corridor);
  const mapping::DistanceField field(corridor);
  const Localizability bare = localizability(walls, field, {0.0, 1.5, 0.3});
  EXPECT_GT(bare.worst_sigma_m, 10.0);
  EXPECT_NEAR(std::abs(std::sin(bare.worst_direction_rad)), 0.0, 1e-3);
  EXPECT_LT(std::sqrt(bare.covariance(1, 1)), 0.01);
  EXPECT_LT(bare.sigma_yaw_rad, 0.002);
  const Path path{{{{0.0, 1.5}, 0.0, 0.0}, {{85.0, 1.5}, 0.0, 0.0}}};
  mapping::Walls closed = corridor;
  test::add_wall(closed, 100.0, 0.0, 100.0, 3.0);
  const auto along = localizability_along(SegmentGrid(closed), mapping::DistanceField(closed), path);
  ASSERT_EQ(along.size(), 2U);
  EXPECT_GT(along[0].worst_sigma_m, 10.0);
  EXPECT_LT(along[1].worst_sigma_m, 0.05);  // the end is in sight
}

TEST(Localizability, ForetellsTheSpreadOfTheRegistration) {
  const mapping::Walls hall = test::laboratory_hall();
  const SegmentGrid walls(hall);
  const Transform2<Map, Base> truth(7.0, 3.0, 0.4);
  ForecastLidar lidar;
  lidar.visible = 1.0;
  const Localizability forecast = localizability(walls, mapping::DistanceField(hall), truth, lidar);
  test::ScanSettings settings = test::full_turn(360, 30.0);
  settings.range_sigma_m = lidar.range_sigma_m;
  std::mt19937 engine(5);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  constexpr int kScans = 300;
  for (int i = 0; i < kScans; ++i) {
    const auto scan = scan_points(test::simulate_scan(hall, truth, settings, engine), {});
    const auto pose = segment_icp(scan, walls, truth).map_from_base;
    const Eigen::Vector3d e(pose.x_m() - truth.x_m(), pose.y_m() - truth.y_m(),
                            pose.yaw_rad() - truth.yaw_rad());
    spread += e * e.transpose() / kScans;
  }
  for (int k = 0; k < 3; ++k) {  // the bound holds, and is not far
    EXPECT_GT(std::sqrt(spread(k, k)), 0.75 * std::sqrt(forecast.covariance(k, k)));
    EXPECT_LT(std::sqrt(spread(k, k)), 2.5 * std::sqrt(forecast.covariance(k, k)));
  }
}

}  // namespace
}  // namespace madori::localization
