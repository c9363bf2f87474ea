#include <gtest/gtest.h>

#include <cmath>

#include "localization/registration/cpd.hpp"
#include "localization/registration/segment_icp.hpp"
#include "localization/slam/strategies.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

class PointRegistration : public testing::Test {
 protected:
  const mapping::Walls walls_ = test::laboratory_hall();
  const mapping::DistanceField field_{walls_};
  const PointMap map_{sample_walls(walls_, 0.05)};
  std::mt19937 engine_{13};

  Pose any_pose() { return test::random_pose(walls_, field_, 0.6, 5.0, engine_); }
  ScanPoints scan_from(const Pose& pose) {
    test::ScanSettings settings;
    settings.range_sigma_m = 0.01;
    return scan_points(test::simulate_scan(walls_, pose, settings, engine_), {});
  }
  static bool right(const Pose& a, const Pose& b, double metres, double degrees) {
    return distance_m(a.translation(), b.translation()) < metres &&
           std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad())) < to_rad(degrees);
  }
};

/// From 0.3 m and 5 degrees off, the distance and turn of bench_registration.
TEST_F(PointRegistration, IcpRecoversAKnownTransform) {
  int good = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose truth = any_pose();
    const double a = 0.7 * i;
    const Pose start(truth.x_m() + 0.3 * std::cos(a), truth.y_m() + 0.3 * std::sin(a),
                     truth.yaw_rad() + to_rad(i % 2 == 0 ? 5.0 : -5.0));
    const RegistrationResult r = point_icp(scan_from(truth), map_, start);
    good += right(r.map_from_base, truth, 0.05, 0.5);
  }
  EXPECT_GE(good, 38);
  EXPECT_FALSE(point_icp({}, map_, {}).converged);
}

TEST_F(PointRegistration, CpdRecoversAKnownTransform) {
  int good = 0;
  for (int i = 0; i < 12; ++i) {
    const Pose truth = any_pose();
    const Pose start(truth.x_m() + 0.25, truth.y_m() + 0.15, truth.yaw_rad() - to_rad(6.0));
    const ScanPoints scan = scan_from(truth);  // a part of the map: CPD alone is rough, as the paper found
    const RegistrationResult rough = cpd(scan, map_, start);
    EXPECT_LT(distance_m(rough.map_from_base.translation(), truth.translation()), 0.25) << i;
    good +=
        right(segment_icp(scan, SegmentGrid(walls_), rough.map_from_base).map_from_base, truth, 0.02, 0.3);
  }
  EXPECT_GE(good, 11);
  EXPECT_FALSE(cpd({}, map_, {}).converged);
  EXPECT_FALSE(cpd(scan_from(any_pose()), PointMap({}), {}).converged);
}

TEST_F(PointRegistration, CpdIsExactOnTheSameSet) {
  ScanPoints scan;
  const Pose truth(3.0, -2.0, 0.3);
  std::vector<Point2<Map>> there;
  std::uniform_real_distribution<double> at(-4.0, 4.0);
  for (int i = 0; i < 120; ++i) {
    scan.add(at(engine_), at(engine_));
    there.push_back(truth * scan.point(static_cast<std::size_t>(i)));
  }
  CpdOptions options;
  options.outliers = 0.01;
  options.max_iterations = 200;
  const RegistrationResult r = cpd(scan, PointMap(there), {3.2, -2.1, 0.4}, options);
  EXPECT_TRUE(r.converged);
  EXPECT_TRUE(right(r.map_from_base, truth, 1e-3, 0.05));
}

TEST_F(PointRegistration, AScanIsFoundAroundWhereItIsExpectedAndAnywhere) {
  const Pose truth(7.0, 2.5, 0.5);
  const ScanPoints scan = scan_from(truth);
  const auto near = localize_around(scan, map_, {7.2, 2.4, 0.45});
  ASSERT_TRUE(near);
  EXPECT_EQ(near->strategy, Strategy::Rdnm);
  EXPECT_TRUE(right(near->fit.map_from_base, truth, 0.03, 0.5));
  EXPECT_GT(near->fit.near_fraction, 0.9);
  const auto lost = localize_absolutely(scan, map_);
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->strategy, Strategy::Absolute);
  EXPECT_TRUE(right(lost->fit.map_from_base, truth, 0.03, 0.5));
  StrategyOptions strict;
  strict.most_e_psr_m = strict.most_e_psr_expected_m = 1e-6;
  EXPECT_FALSE(localize_around(scan, map_, truth, strict));
  EXPECT_FALSE(localize_absolutely(scan, map_, strict));
  EXPECT_FALSE(localize_around(scan, PointMap({}), truth));
}

TEST_F(PointRegistration, GlobalCandidatesAreClearOfTheMap) {
  const auto candidates = global_candidates(map_, 0.5, 0.25);
  EXPECT_GT(candidates.size(), 500U);
  for (const Point2<Map>& p : candidates) EXPECT_GT(field_.distance_m(p), 0.2);
  EXPECT_TRUE(global_candidates(PointMap({}), 0.5, 0.25).empty());
}

}  // namespace
}  // namespace madori::localization
