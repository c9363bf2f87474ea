#include "localization/registration/rdnm.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "localization/registration/point_map.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

class Rdnm : public testing::Test {
 protected:
  const mapping::Walls walls_ = test::laboratory_hall();
  const mapping::DistanceField field_{walls_};
  std::mt19937 engine_{21};

  ScanPoints scan_from(const Pose& pose) {
    return scan_points(test::simulate_scan(walls_, pose, test::full_turn(720, 30.0), engine_), {});
  }
};

TEST(Rdn, AveragesTheNearestSurfaceOfEachSection) {
  const RdnOptions options{.sections = 4, .epsilon_m = 0.5};
  const std::vector<Point2<Map>> points{{2.0, 1.0},
                                        {2.3, 1.0},
                                        {7.0, 1.1},    // first quarter: the last is beyond
                                        {-3.0, 1.0},   // second
                                        {0.9, -3.0}};  // third
  const RdnDescriptor h = rdn<Map>(points, {1.0, 0.0}, options);
  const double near = (std::hypot(1.0, 1.0) + std::hypot(1.3, 1.0)) / 2.0;
  EXPECT_NEAR(h[0], near, 1e-6);
  EXPECT_NEAR(h[1], std::hypot(4.0, 1.0), 1e-6);
  EXPECT_NEAR(h[2], std::hypot(0.1, 3.0), 1e-6);
  EXPECT_EQ(h[3], kEmptySection);
}

TEST_F(Rdnm, TurningTheScanShiftsTheDescriptor) {
  const RdnOptions options;
  const double alpha = 2.0 * kPi / options.sections;
  const ScanPoints scan = scan_from({6.0, 5.5, 0.2});
  const RdnDescriptor h = rdn(scan, options);
  const RdnOptions capped{.norm = RdnNorm::CappedMean};
  for (const int r : {1, 7, 36, 71}) {
    ScanPoints turned;
    const Transform2<Base, Base> turn(0.0, 0.0, r * alpha);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      const Point2<Base> p = turn * scan.point(i);
      turned.add(p.x_m, p.y_m);
    }
    const RdnDescriptor shifted = rdn(turned, options);
    // shift_r of Eq. (2): what was seen in section i is now in section i + r. A point on a border may go
    // either way.
    EXPECT_LT(rdn_difference(h, shifted, r, capped), 0.01) << r;
    EXPECT_GT(rdn_difference(h, shifted, (r + 20) % 72, capped), 0.1) << r;
  }
}

TEST_F(Rdnm, DifferenceIsZeroToItselfAndIgnoresEmptySections) {
  const RdnDescriptor h = rdn(scan_from({6.0, 5.5, 0.2}), {});
  EXPECT_EQ(rdn_difference(h, h, 0), 0.0);
  RdnDescriptor holes = h;
  for (std::size_t i = 0; i < 18; ++i) holes[i] = kEmptySection;
  EXPECT_EQ(rdn_difference(holes, h, 0), 0.0);
  EXPECT_EQ(rdn_difference(RdnDescriptor(72, kEmptySection), h, 0), INFINITY);
}

TEST_F(Rdnm, TheNormIsThePublishedOneOverTheSectionsCompared) {
  const RdnDescriptor a{1.0F, 2.0F, 3.0F, kEmptySection};
  const RdnDescriptor b{1.0F, 4.0F, kEmptySection, 5.0F};
  EXPECT_NEAR(rdn_difference(a, b, 0), std::sqrt(4.0 / 2.0), 1e-6);
  EXPECT_NEAR(rdn_difference(a, b, 0, {.norm = RdnNorm::CappedMean, .unlike_m = 1.0}), 0.5, 1e-6);
}

TEST_F(Rdnm, FindsTheCandidateAndTheTurn) {
  const std::vector<Point2<Map>> map = sample_walls(walls_, 0.05);
  std::vector<Point2<Map>> candidates;
  for (double x : {2.5, 6.0, 10.5, 14.5, 18.5})
    for (double y : {1.0, 4.8, 7.5}) candidates.push_back({x, y});
  int right = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Pose truth(candidates[i].x_m + 0.05, candidates[i].y_m - 0.05, 0.7 * static_cast<double>(i));
    const auto found = rdnm(scan_from(truth), map, candidates);
    ASSERT_TRUE(found);
    right += distance_m(found->map_from_base.translation(), truth.translation()) < 0.1 &&
             std::abs(wrap_angle(found->map_from_base.yaw_rad() - truth.yaw_rad())) < to_rad(6.0);
  }
  EXPECT_GE(right, 14) << "of " << candidates.size();
  EXPECT_FALSE(rdnm({}, map, candidates));
  EXPECT_FALSE(rdnm(scan_from({6.0, 5.5, 0.0}), map, {}));
}

// A corridor with one niche, seen from 0.6 m beside the candidate: the wrong way is in the ranking, and so is
// the right one.
TEST(RdnmRanked, KeepsBothWaysOfACorridor) {
  std::vector<Point2<Map>> map;
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    for (int i = 0; i <= 200; ++i) map.push_back({x0 + (x1 - x0) * i / 200.0, y0 + (y1 - y0) * i / 200.0});
  };
  wall(-10, -1, 10, -1), wall(-10, 1, 3, 1), wall(4, 1, 10, 1), wall(3, 1, 3, 1.6), wall(3, 1.6, 4, 1.6),
      wall(4, 1.6, 4, 1);
  ScanPoints scan;
  const Pose truth(0.6, 0.0, 0.3);
  for (const Point2<Map>& p : map) {
    const Point2<Base> seen = truth.inverse() * p;
    scan.add(seen.x_m, seen.y_m);
  }
  const std::vector<Point2<Map>> candidates{{0.0, 0.0}};
  const std::vector<RdnDescriptor> views{rdn<Map>(map, candidates[0], {})};
  const std::vector<RdnmResult> ranked = rdnm_ranked(scan, candidates, views);
  ASSERT_GE(ranked.size(), 2U);
  const auto ways = [&](double yaw_rad) {
    return std::count_if(ranked.begin(), ranked.end(), [&](const RdnmResult& r) {
      return std::abs(wrap_angle(r.map_from_base.yaw_rad() - yaw_rad)) < to_rad(8.0);
    });
  };
  EXPECT_EQ(ways(0.3), 1);
  EXPECT_EQ(ways(0.3 + kPi), 1);
  // By brute force: the first is the best of all turns, and each is better than those on either side.
  const RdnDescriptor seen = rdn(scan, {});
  const auto difference = [&](int shift) { return rdn_difference(seen, views[0], (shift + 72) % 72); };
  for (const RdnmResult& r : ranked) {
    const int shift = static_cast<int>(std::lround(r.map_from_base.yaw_rad() / (2.0 * kPi / 72)));
    EXPECT_LE(difference(shift), difference(shift - 1));
    EXPECT_LE(difference(shift), difference(shift + 1));
  }
  for (int shift = 0; shift < 72; ++shift) EXPECT_LE(ranked.front().difference_m, difference(shift));
}

}  // namespace
}  // namespace madori::localization
