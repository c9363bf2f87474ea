#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "localization/slam/graph_mapper.hpp"
#include "localization/slam/laid_way.hpp"
#include "localization/slam/slow_lidar_mapper.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"
#include "tests/support/rigid_fit.hpp"

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

TEST(GraphMapper, MapsAHallWithBadWheels) {
  std::mt19937 engine(5);
  test::DriveSettings settings;
  settings.lidar = test::ScanSettings{};
  settings.bias_rad_per_m = 0.03;
  settings.sigma_distance = 0.03;
  const auto moments = test::drive(test::laboratory_hall(), test::kTwoRounds, settings, engine);
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

TEST(GraphMapper, NoiseThatNoLidarHasDoesNotBendTheMap) {
  constexpr double kSigmaM = 0.2;
  std::mt19937 engine(9);
  const auto moments = test::drive(test::laboratory_hall(), test::kTwoRounds, test::half_hertz(), engine);
  GraphMapper mapper;
  std::vector<Transform2<Map, Base>> truth, mapped;
  for (const auto& moment : moments) {
    (void)mapper.on_odometry(moment.odometry);
    if (!moment.has_scan) continue;
    (void)mapper.on_scan(moment.scan.stamp, test::noisy_points(moment.scan, kSigmaM, engine), {});
    truth.push_back(moment.truth);
  }
  const FinishedMap finished = mapper.finish();
  ASSERT_EQ(finished.scans.size(), truth.size());
  for (const MomentPose& pose : finished.scans) mapped.push_back(pose.map_from_base);
  const auto by = test::laid_on(mapped, truth);
  double mean_m = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    mean_m += distance_m((by * mapped[i]).translation(), truth[i].translation()) /
              static_cast<double>(truth.size());
  EXPECT_LT(mean_m, 0.04);
  // The keyframes, which become the walls, stand where their scans do.
  const Memory& memory = finished.memory;
  for (std::size_t k = 0; k < memory.size(); ++k) {
    const auto scan =
        std::ranges::find(finished.scans, memory.keyframes()[k].scan->stamp, &MomentPose::stamp);
    ASSERT_NE(scan, finished.scans.end());
    EXPECT_LT(distance_m(scan->map_from_base.translation(), memory.poses()[k].translation()), 1e-9);
  }
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

/// A lidar that scans every two seconds (0.6 m a scan), with noise on x and y of its points.
TEST(SlowLidarMapper, MapsAHallAndFindsItselfInIt) {
  std::mt19937 engine(7);
  test::DriveSettings settings;
  settings.lidar = test::ScanSettings{};
  settings.steps_per_scan = 6;
  settings.sigma_rad_per_m = 0.03;
  const mapping::Walls walls = test::laboratory_hall();
  const auto moments = test::drive(walls, test::kTwoRounds, settings, engine);
  SlowLidarMapper mapper;
  double worst_m = 0.0;
  for (const auto& moment : moments) {
    (void)mapper.on_odometry(moment.odometry);
    if (!moment.has_scan) continue;
    const auto pose = mapper.on_scan(moment.scan.stamp, scan_points(moment.scan, {}), {}).map_from_base;
    const auto right = moments.front().truth.inverse() * moment.truth;
    worst_m = std::max(worst_m, std::hypot(pose.x_m() - right.x_m(), pose.y_m() - right.y_m()));
  }
  EXPECT_LT(worst_m, 0.03);
  const Transform2<Map, Base> elsewhere(5.0, 7.8, 2.0);
  const ScanPoints scan = scan_points(test::simulate_scan(walls, elsewhere, settings.lidar, engine), {});
  const auto found = localize_absolutely(scan, mapper.map().points(), mapper.strategies_for(scan));
  ASSERT_TRUE(found);
  const auto right = moments.front().truth.inverse() * elsewhere;
  EXPECT_LT(
      std::hypot(found->fit.map_from_base.x_m() - right.x_m(), found->fit.map_from_base.y_m() - right.y_m()),
      0.05);
  EXPECT_EQ(mapper.finish().lost_scans, 0);
}

TEST(SlowLidarMapper, KeepsTheWheelsWordForAScanThatLiesNowhere) {
  std::mt19937 engine(8);
  const mapping::Walls walls = test::laboratory_hall();
  const auto scan = scan_points(test::simulate_scan(walls, {2.5, 1.2, 0.0}, {}, engine), {});
  ScanPoints nonsense;
  std::uniform_real_distribution<double> at(-3.0, 3.0);
  for (int i = 0; i < 300; ++i) nonsense.add(at(engine), at(engine));
  SlowLidarMapper mapper;
  (void)mapper.on_odometry({second(0.0), {}});
  (void)mapper.on_scan(second(0.0), scan, {});
  const std::size_t points = mapper.map().points().points().size();
  (void)mapper.on_odometry({second(2.0), {0.5, 0.0, 0.0}});
  const PoseEstimate pose = mapper.on_scan(second(2.0), nonsense, {});
  EXPECT_EQ(pose.health.state, LocalizationState::Lost);
  EXPECT_NEAR(pose.map_from_base.x_m(), 0.5, 0.05);
  EXPECT_EQ(mapper.map().points().points().size(), points);
  EXPECT_EQ(mapper.finish().lost_scans, 1);
}

/// Twice around the hall, and then carried to another place of it between two scans: the wheels tell nothing
/// of that, the scans do.
class CarriedAway : public testing::Test {
 protected:
  CarriedAway() : moments_(test::drive(walls_, test::kTwoRounds, settings(), engine_)) {
    for (const auto& moment : moments_) {
      (void)mapper_.on_odometry(moment.odometry);
      if (moment.has_scan) (void)mapper_.on_scan(moment.scan.stamp, scan_points(moment.scan, {}), {});
    }
  }
  static test::DriveSettings settings() {
    test::DriveSettings settings;
    settings.lidar = test::ScanSettings{};
    settings.steps_per_scan = 6;
    return settings;
  }
  /// The k-th scan since, `way_m` from where it was put down; what another thing before the lidar hides is
  /// `blinded`.
  LocalizationState see(int k, double way_m, bool blinded = false) {
    const auto truth = put_down_ * Transform2<Base, Base>(way_m, 0.0, 0.0);
    const auto& last = moments_.back().odometry;
    const Stamp stamp = last.stamp + duration_from_seconds(2.0 * k);
    (void)mapper_.on_odometry({stamp, last.odom_from_base * Transform2<Base, Base>(way_m, 0.0, 0.0)});
    ScanPoints scan = scan_points(test::simulate_scan(walls_, truth, settings().lidar, engine_), {});
    if (blinded) {
      scan = {};
      std::uniform_real_distribution<double> at(-3.0, 3.0);
      for (int i = 0; i < 300; ++i) scan.add(at(engine_), at(engine_));
    }
    const PoseEstimate pose = mapper_.on_scan(stamp, scan, {});
    const auto right = moments_.front().truth.inverse() * truth;
    off_m_ = std::hypot(pose.map_from_base.x_m() - right.x_m(), pose.map_from_base.y_m() - right.y_m());
    return pose.health.state;
  }

  std::mt19937 engine_{7};
  const mapping::Walls walls_ = test::laboratory_hall();
  const Transform2<Map, Base> put_down_{5.0, 7.8, 0.0};
  std::vector<test::DriveMoment> moments_;
  SlowLidarMapper mapper_;
  double off_m_ = 0.0;  ///< the last answer, off the truth
};

TEST_F(CarriedAway, IsBelievedOnceScansAgreeOnItAndNotBefore) {
  EXPECT_EQ(see(1, 0.2), LocalizationState::Lost);
  EXPECT_EQ(see(2, 0.4), LocalizationState::Lost);
  EXPECT_EQ(see(3, 0.6), LocalizationState::Localized);
  EXPECT_EQ(see(4, 0.8), LocalizationState::Localized);
  EXPECT_LT(off_m_, 0.1);
  // Between the scan before and the one that was believed no way leads.
  const FinishedMap map = mapper_.finish();
  EXPECT_EQ(map.lost_scans, 2);
  ASSERT_EQ(map.carried.size(), 1U);
  EXPECT_EQ(map.carried.front(), moments_.back().odometry.stamp + duration_from_seconds(6.0));
}

TEST_F(CarriedAway, IsBelievedAlthoughAScanBetweenSaysNothing) {
  EXPECT_EQ(see(1, 0.6), LocalizationState::Lost);
  EXPECT_EQ(see(2, 1.2, true), LocalizationState::Lost);
  EXPECT_EQ(see(3, 1.8), LocalizationState::Lost);
  EXPECT_EQ(see(4, 2.4), LocalizationState::Localized);
  EXPECT_LT(off_m_, 0.1);
}

/// The first scan saw next to nothing (the lidar had just begun to turn): no other is ever found in its map.
TEST(SlowLidarMapper, AFirstScanThatSawLittleIsNotTheMap) {
  std::mt19937 engine(12);
  const auto moments =
      test::drive(test::laboratory_hall(), {{2.5, 1.2}, {11.0, 1.2}}, test::half_hertz(), engine);
  SlowLidarMapper mapper;
  int scans = 0;
  for (const auto& moment : moments) {
    (void)mapper.on_odometry(moment.odometry);
    if (!moment.has_scan) continue;
    ScanPoints points = scan_points(moment.scan, {});
    if (scans++ == 0) {
      points = {};
      for (int i = 0; i < 5; ++i) points.add(0.4, 0.01 * i);
    }
    (void)mapper.on_scan(moment.scan.stamp, points, {});
  }
  const FinishedMap map = mapper.finish();
  EXPECT_EQ(map.lost_scans, 1);
  EXPECT_EQ(static_cast<int>(map.scans.size()), scans - 1);
}

TEST(GrowingMap, ForgetsWhatIsSeenThrough) {
  std::mt19937 engine(9);
  const test::ScanSettings lidar = test::full_turn(720, 30.0);
  mapping::Walls with_box = test::laboratory_hall();
  test::add_box(with_box, 3.0, 0.6, 3.6, 1.2);
  const Transform2<Map, Base> here(1.5, 1.0, 0.0);
  GrowingMap map;
  const auto boxed = [&] {
    int count = 0;
    for (const Point2<Map>& p : map.points().points())
      count += p.x_m > 2.9 && p.x_m < 3.7 && p.y_m > 0.5 && p.y_m < 1.3;
    return count;
  };
  map.add(scan_points(test::simulate_scan(with_box, here, lidar, engine), {}), here, {}, 0.0);
  EXPECT_GT(boxed(), 10);
  for (int i = 0; i < 6; ++i)
    map.add(scan_points(test::simulate_scan(test::laboratory_hall(), here, lidar, engine), {}), here, {},
            0.0);
  EXPECT_EQ(boxed(), 0);
  EXPECT_GT(map.points().points().size(), 300U);
}

/// Noise of 0.2 m on every point, and poses that were led astray: the surfaces bring them back, and do not
/// shrink the map. Corners did, by 2 %.
TEST(SurfaceBundle, BringsPosesBackWithoutBendingTheMap) {
  std::mt19937 engine(31);
  std::normal_distribution<double> noise;
  constexpr double kSigmaM = 0.2;
  test::DriveSettings settings;
  settings.lidar = test::ScanSettings{};
  settings.steps_per_scan = 6;
  std::vector<ScanPoints> scans;
  std::vector<Transform2<Map, Base>> truth, astray;
  for (const auto& moment : test::drive(test::laboratory_hall(), test::kTwoRounds, settings, engine)) {
    if (!moment.has_scan) continue;
    ScanPoints points = scan_points(moment.scan, {});
    for (auto* array : {&points.x_m, &points.y_m})
      for (float& v : *array) v += static_cast<float>(kSigmaM * noise(engine));
    scans.push_back(points);
    truth.push_back(moment.truth);
    const bool is_first = astray.empty();
    astray.push_back(is_first ? moment.truth
                              : Transform2<Map, Base>(moment.truth.x_m() + 0.1 * noise(engine),
                                                      moment.truth.y_m() + 0.1 * noise(engine),
                                                      moment.truth.yaw_rad() + 0.02 * noise(engine)));
  }
  const auto poses = bundle_scans(scans, astray, {}, kSigmaM);
  const auto by = test::laid_on(poses, truth);
  double mean_m = 0.0, way = 0.0, true_way = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    mean_m +=
        distance_m((by * poses[i]).translation(), truth[i].translation()) / static_cast<double>(truth.size());
    way += distance_m(poses[i].translation(), poses[0].translation());
    true_way += distance_m(truth[i].translation(), truth[0].translation());
  }
  EXPECT_LT(mean_m, 0.03);
  EXPECT_NEAR(way / true_way, 1.0, 0.006);
}

/// A law: where everything lies does not change how it lies to each other.
TEST(SurfaceBundle, TurnsWithTheMap) {
  std::mt19937 engine(32);
  const mapping::Walls walls = test::laboratory_hall();
  std::vector<ScanPoints> scans;
  std::vector<Transform2<Map, Base>> poses, moved;
  const Transform2<Map, Map> by(3.0, -7.0, 0.0);
  for (int i = 0; i < 6; ++i) {
    const Transform2<Map, Base> truth(2.5 + 0.6 * i, 1.2, 0.1 * i);
    scans.push_back(scan_points(test::simulate_scan(walls, truth, {}, engine), {}));
    poses.emplace_back(truth.x_m() + (i % 2 == 0 ? 0.0 : 0.05), truth.y_m(), truth.yaw_rad());
    moved.push_back(by * poses.back());
  }
  poses = bundle_scans(scans, poses, {}, 0.0);
  moved = bundle_scans(scans, moved, {}, 0.0);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_LT(distance_m((by * poses[i]).translation(), moved[i].translation()), 0.02) << i;
  EXPECT_NEAR(poses[5].x_m() - poses[0].x_m(), 3.0, 0.01);
}

TEST(SurfaceBundle, LeavesAloneWhatNothingSpeaksOf) {
  EXPECT_TRUE(bundle_scans({}, {}, {}, 0.1).empty());
  const auto alone = bundle_scans({ScanPoints{}}, {{1.0, 2.0, 0.3}}, {}, 0.1);
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_DOUBLE_EQ(alone[0].x_m(), 1.0);
}

/// The ridge of a thick wall is the wall, wherever in the cloud one asks; what fills an area makes none.
TEST(PointMap, ItsSurfaceIsTheRidgeOfANoisyCloud) {
  std::mt19937 engine(33);
  std::normal_distribution<double> noise(0.0, 0.2);
  NoisyPoints cloud;
  cloud.noise_m = 0.2;
  std::uniform_real_distribution<double> anywhere(-1.5, 1.5);
  for (int i = 0; i < 8000; ++i) {
    cloud.points.push_back({4.0 * i / 8000.0 + noise(engine), noise(engine)});
    cloud.points.push_back({10.0 + anywhere(engine), anywhere(engine)});
  }
  cloud.weights.assign(cloud.points.size(), 1.0);
  const PointMap map(std::move(cloud), 0.4);
  for (const double off_m : {-0.2, 0.0, 0.2}) {
    const PointSurface& surface = map.surface(map.nearest({2.5, off_m}).index);
    EXPECT_NEAR(surface.y_m, 0.0, 0.04) << off_m;
    EXPECT_GT(std::abs(surface.normal_y), 0.98);
    EXPECT_DOUBLE_EQ(surface.worth, 1.0);
  }
  EXPECT_LT(map.surface(map.nearest({10.0, 0.0}).index).worth, 1.0);
}

/// Of two places from which a scan's points fit alike, the one where its beams do not go through a wall is
/// likelier.
TEST(Strategies, AScanThatLooksThroughAWallIsUnlikely) {
  std::mt19937 engine(34);
  mapping::Walls walls = test::laboratory_hall();
  const Transform2<Map, Base> here(2.5, 1.2, 0.0);
  const ScanPoints scan = scan_points(test::simulate_scan(walls, here, {}, engine), {});
  const double likely = log_likelihood(scan, PointMap(sample_walls(walls, 0.05)), here);
  test::add_wall(walls, 3.5, 0.2, 3.5, 2.0);
  EXPECT_LT(log_likelihood(scan, PointMap(sample_walls(walls, 0.05)), here), likely - 20.0);
}

/// A lidar at the vehicle's front sees behind corners that hide the same from Base: its beams begin where it
/// sits, or they pass walls that they never met.
TEST(Strategies, BeamsBeginAtTheLidar) {
  std::mt19937 engine(36);
  const mapping::Walls walls = test::laboratory_hall();
  const PointMap map(sample_walls(walls, 0.05));
  const mapping::DistanceField field(walls);
  const Transform2<Base, Lidar> front(0.7, 0.0, 0.0);
  LikelihoodOptions options, at_base;
  options.sensor = front.translation();
  double most = 0.0, most_at_base = 0.0;
  for (int i = 0; i < 40; ++i) {
    const Transform2<Map, Base> eye = test::random_pose(walls, field, 0.5, 4.0, engine);
    const Transform2<Map, Base> here = eye * Transform2<Base, Base>(-0.7, 0.0, 0.0);
    const ScanPoints scan = scan_points(test::simulate_scan(walls, eye, {}, engine), front);
    most = std::max(most, contradiction(scan, map, here, options));
    most_at_base = std::max(most_at_base, contradiction(scan, map, here, at_base));
  }
  EXPECT_LT(most, 0.03);
  EXPECT_GT(most_at_base, 2.0 * most);
}

/// In a map that noise made thick some point is near to everything, and walls that a beam grazes have points
/// far before its end: neither may hide which place it is.
TEST(Strategies, NoiseHidesNoPlace) {
  constexpr double kSigmaM = 0.3;
  std::mt19937 engine(35);
  std::normal_distribution<double> noise(0.0, kSigmaM);
  const mapping::Walls walls = test::laboratory_hall();
  NoisyPoints cloud;
  cloud.noise_m = kSigmaM;
  for (int k = 0; k < 6; ++k)
    for (const Point2<Map>& p : sample_walls(walls, 0.05))
      cloud.points.push_back({p.x_m + noise(engine), p.y_m + noise(engine)});
  cloud.weights.assign(cloud.points.size(), 1.0);
  const PointMap map(std::move(cloud), 2.0 * kSigmaM);
  const mapping::DistanceField field(walls);
  const LikelihoodOptions options = with_noise({}, kSigmaM).likelihood;
  for (int i = 0; i < 10; ++i) {
    const Transform2<Map, Base> here = test::random_pose(walls, field, 0.5, 4.0, engine);
    const ScanPoints scan = test::noisy_points(test::simulate_scan(walls, here, {}, engine), kSigmaM, engine);
    const double likely = log_likelihood(scan, map, here, options);
    EXPECT_GT(likely, -0.6 * static_cast<double>(scan.size())) << here.x_m() << " " << here.y_m();
    const Transform2<Map, Base> beside(here.x_m() + 0.3, here.y_m() + 0.3, here.yaw_rad());
    EXPECT_LT(log_likelihood(scan, map, beside, options), likely - 25.0) << here.x_m() << " " << here.y_m();
  }
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
