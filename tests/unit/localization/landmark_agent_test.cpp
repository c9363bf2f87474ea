// The agent, the hub that several agents report to, what a scan says of its place, and the time of an update.
#include "localization/landmarks/landmark_agent.hpp"

#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/angle.hpp"
#include "localization/landmarks/crossings.hpp"
#include "localization/memory/pose_graph.hpp"
#include "tests/support/ray_caster.hpp"

namespace madori::localization::landmarks {
namespace {

/// An L of two corridors, 2 m wide, with a niche at each end so that no two places look alike.
mapping::Walls ell() {
  const double c[11][2] = {{-1, -1}, {9, -1}, {9, 0},   {10, 0},   {10, 1}, {1, 1},
                           {1, 7},   {0, 7},  {0, 8.2}, {-1, 8.2}, {-1, -1}};
  mapping::Walls walls;
  for (int i = 0; i < 10; ++i) walls.push_back({i, {{c[i][0], c[i][1]}, {c[i + 1][0], c[i + 1][1]}}});
  return walls;
}

class AgentInAnEll : public testing::Test {
 protected:
  Surroundings seen(const Transform2<madori::Map, Base>& pose) {
    test::ScanSettings lidar = test::full_turn(360, 30.0);
    lidar.range_sigma_m = 0.01;
    return look_around(scan_points(test::simulate_scan(walls_, pose, lidar, random_), {}));
  }
  /// One step of dead reckoning with a heading error of 1 % of a radian a metre, and a look.
  std::optional<Sighting> go(LandmarkAgent& agent, double forward_m, double turn_rad) {
    truth_ = truth_ * Transform2<Base, Base>(forward_m, 0.0, turn_rad);
    const double s2 = 4e-4 * std::abs(forward_m) + 1e-8;
    agent.move({{forward_m, 0.0, turn_rad + 0.01 * forward_m},
                {Matrix3::diagonal(s2, s2, s2 + 1e-4 * std::abs(turn_rad))}});
    return agent.look({}, seen(truth_));
  }
  void turn(LandmarkAgent& agent, double angle_rad) {
    for (int i = 0; i < 10; ++i) (void)go(agent, 0.0, 0.1 * angle_rad);
  }
  void drive(LandmarkAgent& agent, double way_m) {
    for (double done = 0.0; done < way_m; done += 0.2) (void)go(agent, 0.2, 0.0);
  }

  mapping::Walls walls_ = ell();
  std::mt19937 random_{7};
  Transform2<madori::Map, Base> truth_{8.0, 0.0, kPi};
  LandmarkHub hub_;
};

TEST_F(AgentInAnEll, RecognisesTheCornerAndTheStartOnItsWayBack) {
  LandmarkAgent agent(hub_);
  (void)agent.look({}, seen(truth_));
  drive(agent, 8.0);
  turn(agent, -0.5 * kPi);
  ASSERT_EQ(hub_.map().size(), 2);
  drive(agent, 5.0);
  turn(agent, kPi);
  drive(agent, 5.0);
  turn(agent, 0.5 * kPi);
  drive(agent, 8.0);
  ASSERT_GE(agent.sightings().size(), 4U);
  EXPECT_TRUE(agent.sightings().back().known);
  EXPECT_EQ(agent.sightings().back().landmark, 0);
  const Transform2<Base, Base> off = Transform2<madori::Map, Base>(8.0, 0.0, kPi).inverse() * truth_;
  EXPECT_NEAR(agent.pose().motion.x_m, off.x_m(), 0.1);
  EXPECT_NEAR(agent.pose().motion.y_m, off.y_m(), 0.1);
  EXPECT_NEAR(wrap_angle(agent.pose().motion.yaw_rad - off.yaw_rad()), 0.0, to_rad(2.0));
}

TEST_F(AgentInAnEll, ACrossingOfTheMemoryIsRecognisedFromBesideItInAnyDirection) {
  Memory memory;
  const auto remember = [&](const Transform2<madori::Map, Base>& pose) {
    test::ScanSettings lidar = test::full_turn(360, 30.0);
    lidar.range_sigma_m = 0.01;
    const auto scan = test::simulate_scan(walls_, pose, lidar, random_);
    SurfaceScan surfaces = make_surface_scan({}, {}, weighty_points(scan_points(scan, {})));
    memory.add(SurfaceScan(surfaces), 0.4, pose, Eigen::Matrix3d::Identity());
    return surfaces;
  };
  for (double x = 8.0; x > 0.0; x -= 0.4) (void)remember({x, 0.0, kPi});
  for (double turned = 0.0; turned < 0.5 * kPi; turned += 0.25) (void)remember({0.0, 0.0, kPi - turned});
  for (double y = 0.4; y < 6.0; y += 0.4) (void)remember({0.0, y, 0.5 * kPi});
  const Crossings crossings(memory);
  ASSERT_GE(crossings.size(), 1U);
  ASSERT_LE(crossings.size(), 3U);
  for (const double yaw : {-2.5, -0.7, 0.4, 1.9}) {
    const Transform2<madori::Map, Base> truth(0.2, 0.3, yaw);
    const auto places = crossings.where(remember(truth));
    const bool found = std::any_of(places.begin(), places.end(), [&](const auto& place) {
      const auto off = truth.inverse() * place;
      return std::hypot(off.x_m(), off.y_m()) < 0.1 && std::abs(off.yaw_rad()) < 0.05;
    });
    EXPECT_TRUE(found) << yaw << ": " << places.size() << " places";
  }
}

TEST_F(AgentInAnEll, AFurtherAgentFindsItselfAndAddsEdges) {
  LandmarkAgent first(hub_);
  (void)first.look({}, seen(truth_));
  drive(first, 8.0);
  turn(first, -0.5 * kPi);
  const double sigma_m = position_sigma_m(hub_.landmark(1).uncertainty);
  truth_ = {0.1, 0.3, 0.5};
  LandmarkAgent second(hub_);
  EXPECT_FALSE(second.look({}, seen(truth_))) << "one place that looks alike is not enough";
  turn(second, -0.53);
  drive(second, 7.9);
  ASSERT_FALSE(second.sightings().empty());
  EXPECT_EQ(second.sightings().front().landmark, 0);
  EXPECT_LT(position_sigma_m(hub_.landmark(1).uncertainty), 0.9 * sigma_m);
  const Transform2<Base, Base> off = Transform2<madori::Map, Base>(8.0, 0.0, kPi).inverse() * truth_;
  EXPECT_NEAR(second.pose().motion.x_m, off.x_m(), 0.1);
  EXPECT_NEAR(second.pose().motion.y_m, off.y_m(), 0.1);
}

TEST_F(AgentInAnEll, ARoughStartIsEnoughButAWrongOneIsNotBelieved) {
  LandmarkAgent first(hub_);
  (void)first.look({}, seen(truth_));
  truth_ = {7.8, 0.1, kPi - 0.1};
  const Matrix3 rough = Matrix3::diagonal(0.04, 0.04, 0.04);
  LandmarkAgent right(hub_, FullPose{{0.0, 0.0, 0.0}, {rough}});
  EXPECT_TRUE(right.look({}, seen(truth_)));
  LandmarkAgent wrong(hub_, FullPose{{-6.0, 1.0, 1.5}, {rough}});
  EXPECT_FALSE(wrong.look({}, seen(truth_)));
}

TEST_F(AgentInAnEll, ARoughlyPlacedAgentAddsPlacesAtOnceAndTheFirstKnownOneCorrectsThem) {
  LandmarkAgent first(hub_);
  (void)first.look({}, seen(truth_));
  truth_ = {0.0, 6.5, 0.5 * kPi};  // where the first agent never was, told 0.3 m and 5 degrees wrong
  const auto off = Transform2<madori::Map, Base>(8.0, 0.0, kPi).inverse() * truth_;
  const Matrix3 rough = Matrix3::diagonal(0.25, 0.25, 0.03);
  LandmarkAgent second(hub_,
                       FullPose{{off.x_m() + 0.3, off.y_m() - 0.1, off.yaw_rad() + to_rad(5.0)}, {rough}});
  turn(second, kPi);
  drive(second, 6.5);
  turn(second, 0.5 * kPi);
  ASSERT_GE(hub_.map().size(), 2) << "a place of its own";
  const double sigma_m = position_sigma_m(hub_.landmark(1).uncertainty);
  drive(second, 8.0);
  ASSERT_TRUE(second.sightings().back().known);
  EXPECT_LT(position_sigma_m(hub_.landmark(1).uncertainty), 0.7 * sigma_m);
  const auto now = Transform2<madori::Map, Base>(8.0, 0.0, kPi).inverse() * truth_;
  EXPECT_NEAR(second.pose().motion.x_m, now.x_m(), 0.1);
  EXPECT_NEAR(second.pose().motion.y_m, now.y_m(), 0.1);
}

TEST_F(AgentInAnEll, TheStrategyLeadsToTheSurestLandmark) {
  const FullPose leg{{5.0, 0.0, 0.0}, {Matrix3::diagonal(0.01, 0.01, 0.001)}};
  for (int i = 0; i < 4; ++i) (void)hub_.add({});
  hub_.measure(0, 1, leg);
  hub_.measure(1, 2, leg);
  EXPECT_EQ(surer_landmark(hub_, 2, 1.0), 0);
  EXPECT_FALSE(surer_landmark(hub_, 3, 1.0)) << "nothing leads anywhere from there";
}

TEST(Surroundings, CountTheWaysOnAndTheWidth) {
  const mapping::Walls walls = ell();
  std::mt19937 random(1);
  const auto at = [&](double x, double y) {
    return look_around(
        scan_points(test::simulate_scan(walls, {x, y, 0.3}, test::full_turn(360, 30.0), random), {}));
  };
  EXPECT_EQ(at(4.5, 0.0).openings, 2) << "in the corridor";
  EXPECT_EQ(at(0.0, 0.0).openings, 2) << "in the corner";
  EXPECT_NEAR(at(4.5, 0.0).corridor_width_m, 2.0, 0.2);
}

double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What the vehicle sees when it is switched on in a hall, compared with a crossing of narrow aisles: it was
/// half a minute a crossing.
TEST(LandmarkTime, AWideHallIsComparedWithANarrowCrossingAsFastAsTheCrossingItself) {
  const mapping::Walls aisle = ell();
  mapping::Walls hall;
  const double c[5][2] = {{-16, -12}, {16, -12}, {16, 12}, {-16, 12}, {-16, -12}};
  for (int i = 0; i < 4; ++i) hall.push_back({i, {{c[i][0], c[i][1]}, {c[i + 1][0], c[i + 1][1]}}});
  const auto in = [](const mapping::Walls& walls) {
    std::mt19937 random(1);
    return look_around(
        scan_points(test::simulate_scan(walls, {0.2, 0.1, 0.3}, test::full_turn(360, 30.0), random), {}));
  };
  const Surroundings crossing = in(aisle);
  const auto takes_s = [&](const Surroundings& seen) {
    const double before = cpu_s();
    (void)recognise_anywhere(crossing.descriptor, seen);
    return cpu_s() - before;
  };
  const double itself_s = takes_s(crossing);
  EXPECT_LT(takes_s(in(hall)), 5.0 * itself_s) << itself_s;
}

/// 20 landmarks in a grid of aisles, the loop just closed: processor time beside that of Ceres on the same
/// graph. The limit is the issue's; the ratio does not depend on the machine.
TEST(LandmarkTime, AnUpdateOfTwentyLandmarks) {
  auto graph = std::make_unique<LandmarkGraph<FullUncertainty, 20>>();
  std::vector<RelativeFactor> factors;
  std::vector<SolvedLandmark> start(20);
  std::vector<Transform2<madori::Map, Base>> poses;
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0.0, 0.02);
  for (int i = 0; i < 20; ++i) {
    start[i].pose = {2.0 * (i % 5) + (i > 0 ? normal(random) : 0.0),
                     2.0 * (i / 5) + (i > 0 ? normal(random) : 0.0), 0.0};
    start[i].uncertainty.covariance = Matrix3::diagonal(1.0, 1.0, 1.0);
    poses.emplace_back(start[i].pose.x_m, start[i].pose.y_m, 0.0);
    for (const int back : {i % 5 > 0 ? 1 : 0, i >= 5 ? 5 : 0}) {
      if (back == 0) continue;
      const Displacement z{back == 1 ? 2.0 + normal(random) : normal(random),
                           back == 5 ? 2.0 + normal(random) : normal(random), normal(random)};
      graph->fuse(i - back, i, {z, {Matrix3::diagonal(4e-4, 4e-4, 4e-4)}});
      factors.push_back(
          {i - back, i, {z.x_m, z.y_m, z.yaw_rad}, 2500.0 * Eigen::Matrix3d::Identity(), false});
    }
  }
  constexpr int kRounds = 50;
  double fastest = 1.0, fastest_ceres = 1.0;
  for (int round = 0; round < kRounds; ++round) {
    auto landmarks = start;
    double before = cpu_s();
    (void)solve_landmarks(*graph, 20, landmarks.data());
    fastest = std::min(fastest, cpu_s() - before);
    auto by_ceres = poses;
    before = cpu_s();
    (void)optimise_graph(by_ceres, factors, {});
    fastest_ceres = std::min(fastest_ceres, cpu_s() - before);
  }
  std::printf("update of 20 landmarks: %.0f us; Ceres %.0f us (without covariances)\n", 1e6 * fastest,
              1e6 * fastest_ceres);
  EXPECT_LT(fastest, fastest_ceres);
}

}  // namespace
}  // namespace madori::localization::landmarks
