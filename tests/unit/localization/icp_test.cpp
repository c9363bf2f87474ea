#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "localization/registration/point_icp.hpp"
#include "localization/registration/segment_icp.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

double position_error_m(const Pose& a, const Pose& b) {
  return distance_m(a.translation(), b.translation());
}
double heading_error_rad(const Pose& a, const Pose& b) {
  return std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad()));
}

/// A start `metres` and `degrees` off in a random direction.
template <class Engine>
Pose off_by(const Pose& truth, double metres, double degrees, Engine& engine) {
  std::uniform_real_distribution<double> direction(-kPi, kPi);
  const double a = direction(engine);
  const double turn = direction(engine) < 0.0 ? -degrees : degrees;
  return {truth.x_m() + metres * std::cos(a), truth.y_m() + metres * std::sin(a),
          truth.yaw_rad() + to_rad(turn)};
}

class Icp : public testing::Test {
 protected:
  const mapping::Walls walls_ = test::laboratory_hall();
  const mapping::DistanceField field_{walls_};
  const SegmentGrid grid_{walls_};
  const PointMap map_{sample_walls(walls_, 0.02)};
  std::mt19937 engine_{7};

  Pose any_pose() { return test::random_pose(walls_, field_, 0.5, 4.0, engine_); }
  ScanPoints scan_from(const Pose& pose, double sigma_m, double clutter) {
    test::ScanSettings settings;
    settings.range_sigma_m = sigma_m;
    settings.clutter = clutter;
    return scan_points(test::simulate_scan(walls_, pose, settings, engine_), {});
  }
};

TEST_F(Icp, PointToSegmentRecoversAKnownTransform) {
  for (int i = 0; i < 100; ++i) {
    const Pose truth = any_pose();
    const RegistrationResult r =
        segment_icp(scan_from(truth, 0.0, 0.0), grid_, off_by(truth, 0.3, 5.0, engine_));
    EXPECT_TRUE(r.converged) << i;
    EXPECT_LT(position_error_m(r.map_from_base, truth), 2e-3) << i;
    EXPECT_LT(heading_error_rad(r.map_from_base, truth), 1e-3) << i;
    EXPECT_LT(r.e_psr_m, 2e-3) << i;
    EXPECT_GT(r.inlier_fraction, 0.99) << i;
  }
}

TEST_F(Icp, PointToSegmentHoldsWithNoiseAndClutter) {
  int right = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose truth = any_pose();
    const RegistrationResult r =
        segment_icp(scan_from(truth, 0.01, 0.3), grid_, off_by(truth, 0.3, 5.0, engine_));
    right +=
        position_error_m(r.map_from_base, truth) < 0.02 && heading_error_rad(r.map_from_base, truth) < 0.005;
  }
  EXPECT_GE(right, 97);
}

TEST_F(Icp, TheCovarianceTellsTheErrorsSize) {
  double squared = 0.0;
  constexpr int kRounds = 200;
  for (int i = 0; i < kRounds; ++i) {
    const Pose truth = any_pose();
    const RegistrationResult r =
        segment_icp(scan_from(truth, 0.02, 0.0), grid_, off_by(truth, 0.1, 1.0, engine_));
    const Eigen::Vector3d e(r.map_from_base.x_m() - truth.x_m(), r.map_from_base.y_m() - truth.y_m(),
                            wrap_angle(r.map_from_base.yaw_rad() - truth.yaw_rad()));
    squared += e.dot(r.covariance.inverse() * e);
  }
  EXPECT_GT(squared / kRounds, 1.5);  // 3 were it exact
  EXPECT_LT(squared / kRounds, 6.0);
}

TEST_F(Icp, ABareCorridorIsUnseenAlongItself) {
  mapping::Walls corridor;
  test::add_wall(corridor, -100.0, 0.0, 100.0, 0.0);
  test::add_wall(corridor, -100.0, 2.0, 100.0, 2.0);
  const ScanPoints scan =
      scan_points(test::simulate_scan(corridor, {0.0, 1.0, 0.0}, test::full_turn(360, 20.0), engine_), {});
  const RegistrationResult r = segment_icp(scan, SegmentGrid(corridor), {0.2, 1.1, 0.05});
  EXPECT_TRUE(r.converged);
  EXPECT_GT(r.covariance(0, 0), 1e3);
  EXPECT_LT(r.covariance(1, 1), 1e-4);
  EXPECT_NEAR(r.map_from_base.y_m(), 1.0, 1e-3);
}

TEST_F(Icp, NothingToMatchIsNoSuccess) {
  const RegistrationResult none = segment_icp({}, grid_, {1.0, 2.0, 0.3});
  EXPECT_FALSE(none.converged);
  EXPECT_EQ(none.inliers, 0);
  const RegistrationResult far = segment_icp(scan_from(any_pose(), 0.0, 0.0), grid_, {500.0, 2.0, 0.3});
  EXPECT_FALSE(far.converged);
  EXPECT_FALSE(point_icp({}, map_, {1.0, 2.0, 0.3}).converged);
  EXPECT_FALSE(point_icp(scan_from(any_pose(), 0.0, 0.0), PointMap({}), {}).converged);
}

TEST_F(Icp, PointsThatFaceElsewhereAreLeftOut) {
  const Pose truth(2.0, 5.0, 0.0);
  ScanPoints scan = scan_from(truth, 0.0, 0.0);
  scan.normal_x.assign(scan.size(), 0.0F);
  scan.normal_y.assign(scan.size(), 0.0F);
  const RegistrationResult unknown = segment_fit(scan, grid_, truth);
  scan.normal_x.assign(scan.size(), 1.0F);  // claims: every surface looks along x
  const RegistrationResult along_x = segment_fit(scan, grid_, truth);
  EXPECT_GT(unknown.hessian(1, 1), 50.0);
  EXPECT_LT(along_x.hessian(1, 1), 1.0);
  EXPECT_GT(along_x.hessian(0, 0), 50.0);
}

TEST_F(Icp, PointToPointRecoversAKnownTransform) {
  for (int i = 0; i < 30; ++i) {
    const Pose truth = any_pose();
    const RegistrationResult r =
        point_icp(scan_from(truth, 0.005, 0.0), map_, off_by(truth, 0.15, 3.0, engine_));
    EXPECT_LT(position_error_m(r.map_from_base, truth), 0.03) << i;
    EXPECT_LT(heading_error_rad(r.map_from_base, truth), 0.01) << i;
  }
}

TEST(PointMap, NearestIsWhatBruteForceFinds) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> at(-5.0, 5.0);
  std::vector<Point2<Map>> points(300);
  for (auto& p : points) p = {at(engine), at(engine)};
  const PointMap map(points);
  for (int i = 0; i < 200; ++i) {
    const Point2<Map> q{at(engine), at(engine)};
    double best = 1e9;
    for (const auto& p : points) best = std::min(best, distance_m(p, q));
    EXPECT_NEAR(std::sqrt(map.nearest(q).squared_distance_m2), best, 1e-12);
  }
}

}  // namespace
}  // namespace madori::localization
