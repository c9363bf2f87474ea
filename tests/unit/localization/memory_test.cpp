#include "localization/memory/memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "localization/memory/local_map.hpp"
#include "localization/memory/pose_graph.hpp"
#include "localization/scan_points.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

SurfaceScan look(const Transform2<Map, Base>& pose, std::mt19937& engine, double sigma_m = 0.01) {
  test::ScanSettings settings = test::full_turn(360, 30.0);
  settings.range_sigma_m = sigma_m;
  const LaserScan scan = test::simulate_scan(test::laboratory_hall(), pose, settings, engine);
  std::vector<Point2<Base>> points;
  const ScanPoints seen = scan_points(scan, {});
  for (std::size_t i = 0; i < seen.size(); ++i) points.push_back(seen.point(i));
  return make_surface_scan({}, {}, points);
}

TEST(SurfaceScan, NormalsStandOnTheWallsAndLookAtTheSensor) {
  std::mt19937 engine(1);
  const SurfaceScan scan = look({10.0, 8.0, 0.3}, engine, 0.0);
  int directed = 0;
  for (const SurfacePoint& p : scan.points) {
    if (!p.has_normal()) continue;
    ++directed;
    EXPECT_LT(p.normal_x * p.x_m + p.normal_y * p.y_m, 0.0);
    EXPECT_NEAR(std::hypot(p.normal_x, p.normal_y), 1.0, 1e-9);
  }
  EXPECT_GT(directed, static_cast<int>(scan.points.size()) * 8 / 10);
}

/// Beside a search through all points. What was found for a place beside it changes nothing.
TEST(LocalMap, FindsTheNearestSurfaceThatLooksTheSameWay) {
  std::mt19937 engine(9);
  const Transform2<Map, Base> from(10.0, 8.0, 0.3), beside(11.0, 8.5, 1.9);
  const SurfaceScan one = look(from, engine, 0.02), other = look(beside, engine, 0.02);
  const LocalMap map({{&one, from}, {&other, beside}}, {10.0, 8.0}, 9.0);
  std::vector<SurfacePoint> surfaces;
  for (const auto& [scan, pose] : {std::pair{&one, from}, std::pair{&other, beside}})
    for (const SurfacePoint& s : scan->points)
      if (const SurfacePoint q = moved(pose, s);
          q.has_normal() && std::hypot(q.x_m - 10.0, q.y_m - 8.0) < 9.0)
        surfaces.push_back(q);
  std::uniform_real_distribution<double> place(-1.0, 20.0), turn(-kPi, kPi), share(0.1, 1.0);
  int found = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double yaw = turn(engine), reach_m = 0.6 * share(engine);
    SurfacePoint p{place(engine), place(engine), std::cos(yaw), std::sin(yaw)};
    if (i % 5 == 0) p.normal_x = p.normal_y = 0.0;
    double least_m = reach_m;
    for (const SurfacePoint& q : surfaces)
      if (!p.has_normal() || q.normal_x * p.normal_x + q.normal_y * p.normal_y > kSameSurfaceCosine)
        least_m = std::min(least_m, std::hypot(q.x_m - p.x_m, q.y_m - p.y_m));
    const LocalMap::Entry* nearest = map.nearest(p, reach_m, nullptr);
    ASSERT_EQ(nearest != nullptr, least_m < reach_m) << i;
    if (nearest == nullptr) continue;
    ++found;
    EXPECT_NEAR(std::hypot(nearest->point.x_m - p.x_m, nearest->point.y_m - p.y_m), least_m, 1e-9);
    SurfacePoint near = p;
    near.x_m += 0.05 * share(engine);
    EXPECT_EQ(map.nearest(near, reach_m, nearest), map.nearest(near, reach_m, nullptr));
  }
  EXPECT_GT(found, 200);
}

/// A wall 4 m ahead, 6 m long, points 3.5 cm apart with noise on x and y: where so much noise is known, more
/// neighbours tell the wall's direction.
TEST(SurfaceScan, NoisyPointsTellTheDirectionTogether) {
  for (const double sigma_m : {0.0, 0.02, 0.1, 0.2}) {
    std::mt19937 engine(4);
    std::normal_distribution<double> noise(0.0, sigma_m + 1e-9);
    std::vector<Point2<Base>> points;
    for (double y = -3.0; y < 3.0; y += 0.035) points.push_back({4.0 + noise(engine), y + noise(engine)});
    const auto right_share = [&](double known_m) {
      SurfaceScanOptions options;
      options.noise_m = known_m;
      const SurfaceScan scan = make_surface_scan({}, {}, points, options);
      double right = 0.0;
      for (const SurfacePoint& p : scan.points) right += p.normal_x < -std::cos(to_rad(15.0)) ? 1.0 : 0.0;
      return right / static_cast<double>(scan.points.size());
    };
    if (sigma_m > kUsualNoiseM) {
      EXPECT_GT(right_share(sigma_m), 0.8) << sigma_m;
      EXPECT_LT(right_share(0.0), 0.4) << sigma_m;
    } else {
      EXPECT_EQ(right_share(sigma_m), right_share(0.0)) << "of lidars that there are nothing changes";
    }
  }
}

TEST(ScoreGrid, APointScoresByTheMarksAroundIt) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> place(-3.0, 3.0), weight(0.0, 1.0);
  std::vector<ScoreGrid::Mark> marks;
  for (int k = 0; k < 300; ++k) marks.push_back({{place(engine), place(engine)}, weight(engine)});
  const ScoreGrid grid(marks);
  const auto cell_of = [](double m, double least) {
    return static_cast<int>((m - least) / ScoreGrid::kResolutionM);
  };
  double low_x = 1e9, low_y = 1e9;
  for (const auto& [p, w] : marks) low_x = std::min(low_x, p.x_m), low_y = std::min(low_y, p.y_m);
  for (int trial = 0; trial < 500; ++trial) {
    const Point2<Map> at{low_x + std::abs(place(engine)), low_y + std::abs(place(engine))};
    unsigned expected = 0;  // smeared by 7 cm over four cells to each side
    for (const auto& [p, w] : marks) {
      const int dx = cell_of(p.x_m, low_x) - cell_of(at.x_m, low_x);
      const int dy = cell_of(p.y_m, low_y) - cell_of(at.y_m, low_y);
      if (std::abs(dx) > 4 || std::abs(dy) > 4) continue;
      const double d = std::hypot(dx, dy) * ScoreGrid::kResolutionM / 0.07;
      const auto full = static_cast<unsigned>(std::lround(255.0 * std::exp(-0.5 * d * d)));
      expected = std::max(expected, full * static_cast<unsigned>(std::lround(256.0 * w)) >> 8U);
    }
    SurfaceScan scan;
    scan.points.push_back({0.0, 0.0, 0.0, 0.0});
    const SearchResult found = grid.search(scan, {at.x_m, at.y_m, 0.0}, {0.0, 0.0, 0.1, 0.1});
    ASSERT_NEAR(255.0 * found.score, expected, 1e-9) << trial;
  }
}

TEST(LocalMap, FindsALargeMotionAndRefinesItToCentimetres) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> jump(-1.0, 1.0);
  const Transform2<Map, Base> here(10.0, 8.0, 0.3);
  const SurfaceScan before = look(here, engine);
  const LocalMap map({{&before, here}}, here.translation(), 20.0);
  for (int i = 0; i < 20; ++i) {
    const Transform2<Map, Base> truth(10.0 + 0.5 * jump(engine), 8.0 + 0.5 * jump(engine),
                                      0.3 + 0.4 * jump(engine));
    const SurfaceScan now = look(truth, engine);
    SearchWindow window{0.8, 0.5, 0.5, 0.5};
    const MatchResult match = map.refine(now, map.search(now, here, window).map_from_base, {});
    EXPECT_LT(distance_m(match.map_from_base.translation(), truth.translation()), 0.02);
    EXPECT_LT(std::abs(wrap_angle(match.map_from_base.yaw_rad() - truth.yaw_rad())), to_rad(0.3));
    EXPECT_GT(match.inlier_share, 0.8);
  }
}

TEST(LocalMap, ABareCorridorGivesNoInformationAlong) {
  mapping::Walls corridor;
  test::add_wall(corridor, -50.0, -1.0, 50.0, -1.0);
  test::add_wall(corridor, -50.0, 1.0, 50.0, 1.0);
  std::mt19937 engine(3);
  const LaserScan scan =
      test::simulate_scan(corridor, Transform2<Map, Base>(), test::full_turn(360, 15.0), engine);
  std::vector<Point2<Base>> points;
  const ScanPoints seen = scan_points(scan, {});
  for (std::size_t i = 0; i < seen.size(); ++i) points.push_back(seen.point(i));
  const SurfaceScan surface = make_surface_scan({}, {}, points);
  const LocalMap map({{&surface, Transform2<Map, Base>()}}, {}, 20.0);
  const MatchResult match = map.refine(surface, {}, {});
  EXPECT_LT(match.information(0, 0), 1e-3 * match.information(1, 1));
}

TEST(LocalMap, MemoryThatIsUsedAgainCarriesNothingOver) {
  std::mt19937 engine(5);
  const Transform2<Map, Base> first(10.0, 8.0, 0.3), second(14.0, 6.0, -0.4);
  const SurfaceScan before = look(first, engine), after = look(second, engine);
  const SurfaceScan now = look({14.1, 6.1, -0.35}, engine);
  const SearchWindow window{0.5, 0.3, 0.5, 0.5};
  LocalMap again({{&before, first}, {&after, second}}, first.translation(), 20.0);
  (void)again.search(now, first, window);  // with a grid of its own
  again.build({{&after, second}}, second.translation(), 9.0);
  const LocalMap fresh({{&after, second}}, second.translation(), 9.0);
  EXPECT_EQ(again.search(now, second, window).score, fresh.search(now, second, window).score);
  const MatchResult a = again.refine(now, second, {}), b = fresh.refine(now, second, {});
  EXPECT_EQ(a.information, b.information);
  EXPECT_EQ(a.map_from_base.x_m(), b.map_from_base.x_m());
  EXPECT_EQ(a.inlier_share, b.inlier_share);
  again.build({}, second.translation(), 9.0);
  EXPECT_TRUE(again.empty());
  EXPECT_FALSE(again.refine(now, second, {}).converged);
}

TEST(PoseGraph, ALoopClosureSpreadsTheDriftOfASquare) {
  std::vector<Transform2<Map, Base>> truth, poses;
  std::vector<RelativeFactor> factors;
  const Transform2<Base, Base> side(1.0, 0.0, 0.0), corner(0.0, 0.0, kPi / 2.0), bias(0.0, 0.0, 0.002);
  Transform2<Map, Base> at, drifted;
  for (int i = 0; i < 40; ++i) {
    truth.push_back(at);
    poses.push_back(drifted);
    const Transform2<Base, Base> motion = i % 10 == 9 ? side * corner : side;
    at = at * motion;
    drifted = drifted * (motion * bias);
    if (i > 0) {
      factors.push_back(
          {i - 1, i, poses[i - 1].inverse() * poses[i], 1e4 * Eigen::Matrix3d::Identity(), false});
    }
  }
  factors.push_back({0, 39, truth[0].inverse() * truth[39], 1e4 * Eigen::Matrix3d::Identity(), true});
  const double before = distance_m(poses[20].translation(), truth[20].translation());
  ASSERT_TRUE(optimise_graph(poses, factors, {}));
  EXPECT_LT(distance_m(poses[39].translation(), truth[39].translation()), 0.05);
  EXPECT_LT(distance_m(poses[20].translation(), truth[20].translation()), 0.5 * before);
}

TEST(PoseGraph, AWrongLoopClosureLetsGo) {
  std::vector<Transform2<Map, Base>> poses;
  std::vector<RelativeFactor> factors;
  for (int i = 0; i < 30; ++i) {
    poses.emplace_back(i, 0.0, 0.0);
    if (i > 0) factors.push_back({i - 1, i, {1.0, 0.0, 0.0}, 1e4 * Eigen::Matrix3d::Identity(), false});
  }
  factors.push_back({0, 29, {10.0, 12.0, 1.5}, 1e4 * Eigen::Matrix3d::Identity(), true});
  ASSERT_TRUE(optimise_graph(poses, factors, {}));
  EXPECT_NEAR(poses[29].x_m(), 29.0, 0.5);
  EXPECT_NEAR(poses[29].y_m(), 0.0, 0.5);
}

/// A vehicle whose measured motions turn a little too much comes back to where it began and sees it: the way
/// in between is bent straight, which it would not be if the finding were entered as one more motion.
TEST(Memory, AnOldPlaceFoundAgainBendsTheWayBetween) {
  std::mt19937 engine(4);
  Memory memory;
  std::vector<Transform2<Map, Base>> truth;
  Transform2<Map, Base> believed;
  Transform2<Base, Base> measured;
  double worst_m = 0.0;
  for (int i = 0; i < 72; ++i) {  // circles of 4 m around (10, 8)
    const double a = i * to_rad(10.0);
    const Transform2<Map, Base> here(10.0 + 3.0 * std::cos(a), 8.0 + 3.0 * std::sin(a), a + kPi / 2.0);
    if (i > 0) measured = truth.back().inverse() * here * Transform2<Base, Base>(0.0, 0.0, to_rad(0.25));
    truth.push_back(here);
    believed = i == 0 || i == 71 ? here : believed * measured;  // found again at the end
    worst_m = std::max(worst_m, distance_m(believed.translation(), here.translation()));
    const Eigen::Matrix3d information = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
    memory.add(look(here, engine), 0.524, believed, MeasuredMotion{measured, information});
  }
  ASSERT_GT(worst_m, 0.5);
  EXPECT_GT(memory.close_loops(), 0);
  UnaryFactor start;
  start.at = truth.front();
  start.hessian = 1e4 * Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(memory.optimise({start}));
  double off_m = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    off_m = std::max(off_m, distance_m(memory.poses()[i].translation(), truth[i].translation()));
  }
  EXPECT_LT(off_m, 0.3 * worst_m);
  const Transform2<Map, Map> away(0.0, 1.5, 0.1);
  const std::size_t newest = memory.window_begin();
  EXPECT_DOUBLE_EQ(memory.loops_against({}, newest), 0.0);
  EXPECT_GT(memory.loops_against(away, newest), 20.0);
  EXPECT_DOUBLE_EQ(memory.loops_against(away, 0), 0.0);  // all of it together tears no loop
}

TEST(Memory, TellsTheWeakestLinkOfAStretch) {
  std::mt19937 engine(5);
  Memory memory;
  for (const double agreement : {1.0, 0.3, 0.9, 0.7, 0.8}) {
    memory.add(look({10.0, 8.0, 0.0}, engine), 0.5, {10.0, 8.0, 0.0},
               MeasuredMotion{{}, Eigen::Matrix3d::Identity(), agreement});
  }
  EXPECT_DOUBLE_EQ(memory.weakest_agreement(0), 0.3);
  EXPECT_DOUBLE_EQ(memory.weakest_agreement(2), 0.7);
}

TEST(Memory, IsLedOtherwise) {
  Memory memory;
  const SurfaceScan scan;
  for (int k = 0; k < 4; ++k)
    memory.add(scan, 1.0, {1.0 * k, 0.0, 0.0},
               MeasuredMotion{{1.0, 0.0, 0.0}, 400.0 * Eigen::Matrix3d::Identity()});
  memory.tie({{0, 3, {3.0, 0.0, 0.0}, 400.0 * Eigen::Matrix3d::Identity(), true}});
  memory.lead_otherwise(2, {1, 2, {0.0, 1.0, 0.5 * kPi}, 400.0 * Eigen::Matrix3d::Identity(), false});
  EXPECT_NEAR(memory.poses()[2].y_m(), 1.0, 1e-12);
  EXPECT_NEAR(memory.poses()[3].x_m(), 1.0, 1e-12);
  EXPECT_NEAR(memory.poses()[3].y_m(), 2.0, 1e-12);
  EXPECT_EQ(memory.factors().size(), 3U);  // the loop led across
  EXPECT_EQ(memory.pieces().back(), 0U);
}

TEST(PoseGraph, AUnaryFactorPullsOnlyWhereItSees) {
  std::vector<Transform2<Map, Base>> poses{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  const std::vector<RelativeFactor> factors{
      {0, 1, {1.0, 0.0, 0.0}, 1e4 * Eigen::Matrix3d::Identity(), false}};
  UnaryFactor prior;
  prior.hessian = 1e4 * Eigen::Matrix3d::Identity();
  UnaryFactor wall;  // a wall across: only y, and it lies 0.2 m to the left
  wall.node = 1;
  wall.at = poses[1];
  wall.hessian(1, 1) = 1e4;
  wall.gradient[1] = -1e4 * 0.2;
  ASSERT_TRUE(optimise_graph(poses, factors, {prior, wall}));
  EXPECT_NEAR(poses[1].x_m(), 1.0, 0.02);
  EXPECT_GT(poses[1].y_m(), 0.08);
}

}  // namespace
}  // namespace madori::localization
