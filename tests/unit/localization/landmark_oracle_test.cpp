// The landmark graph against Ceres on random graphs: chains, grids, the cube, K3,3, with wrong loops.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "core/median.hpp"
#include "localization/landmarks/elimination.hpp"
#include "localization/landmarks/reductions.hpp"
#include "localization/memory/pose_graph.hpp"

namespace madori::localization::landmarks {
namespace {

constexpr int kMost = 64;
using FullGraph = LandmarkGraph<FullUncertainty, kMost>;
using PublishedGraph = LandmarkGraph<ScalarUncertainty, kMost>;

/// One made-up building: true places, the pairs that are measured, and how well.
struct Building {
  std::vector<Displacement> truth;
  std::vector<std::pair<int, int>> pairs;
};

Building grid(int columns, int rows, std::mt19937& random) {
  std::uniform_real_distribution<double> yaw(-kHalfTurn_rad, kHalfTurn_rad);
  Building b;
  for (int i = 0; i < columns * rows; ++i) {
    b.truth.push_back(i == 0 ? Displacement{}
                             : Displacement{2.0 * (i % columns), 2.0 * (i / columns), yaw(random)});
    if (i % columns > 0) b.pairs.emplace_back(i - 1, i);
    if (i >= columns) b.pairs.emplace_back(i - columns, i);
  }
  return b;
}

Building building(int kind, std::mt19937& random) {
  const auto between = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  if (kind == 0) return grid(between(2, 20), 1, random);
  if (kind == 1) return grid(between(2, 8), between(2, 8), random);
  Building b = grid(kind == 2 ? 4 : 3, 2, random);
  b.pairs.clear();
  if (kind == 2) {
    for (int i = 0; i < 8; ++i)
      for (int axis = 1; axis < 8; axis *= 2)
        if ((i & axis) == 0) b.pairs.emplace_back(i, i | axis);
  } else {
    for (int i = 0; i < 9; ++i) b.pairs.emplace_back(i / 3, 3 + i % 3);
  }
  return b;
}

struct Trial {
  Building building;
  FullGraph graph;
  PublishedGraph published;
  std::vector<RelativeFactor> factors;
};

/// `linear`: every orientation is known to a microradian, so that the positions are a linear problem. Else
/// the noise is that of odometry over an aisle. One in three has wrong loops: measurements of another pair.
std::unique_ptr<Trial> make_trial(int number, bool linear, std::mt19937& random) {
  auto trial = std::make_unique<Trial>();
  trial->building = building(number % 4, random);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> sigma(0.01, 0.05);
  const int nodes = static_cast<int>(trial->building.truth.size());
  auto pairs = trial->building.pairs;
  const int wrong = number % 3 == 0 ? 1 + number % 2 : 0;
  for (int i = 0; i < wrong; ++i)
    pairs.emplace_back(0, std::uniform_int_distribution<int>(1, nodes - 1)(random));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [from, to] = pairs[i];
    const bool is_wrong = i + wrong >= pairs.size();
    Displacement z = trial->building.truth[from].inverse() * trial->building.truth[to];
    Matrix3 root = Matrix3::diagonal(sigma(random), sigma(random), linear ? 1e-6 : sigma(random));
    if (!linear)
      root(1, 0) = 0.5 * sigma(random), root(2, 0) = 0.3 * sigma(random), root(2, 1) = -0.3 * sigma(random);
    const Vector3 noise = root * Vector3{{normal(random), normal(random), linear ? 0.0 : normal(random)}};
    z = {z.x_m + noise[0] + (is_wrong ? 0.5 : 0.0), z.y_m + noise[1] - (is_wrong ? 0.3 : 0.0),
         z.yaw_rad + noise[2]};
    const FullPose edge{z, {root * transposed(root)}};
    trial->graph.fuse(from, to, edge);
    trial->published.fuse(from, to, {z, ScalarUncertainty::of(edge.uncertainty.covariance)});
    Eigen::Matrix3d covariance;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) covariance(r, c) = edge.uncertainty.covariance(r, c);
    trial->factors.push_back({from, to, {z.x_m, z.y_m, z.yaw_rad}, covariance.inverse(), false});
  }
  return trial;
}

Transform2<Map, Base> transform(const Displacement& d) {
  return {d.x_m, d.y_m, d.yaw_rad};
}

/// Covariance of all nodes but the first, from the errors' numerical derivatives at the answer.
Eigen::MatrixXd oracle_covariance(const std::vector<RelativeFactor>& factors,
                                  const std::vector<Transform2<Map, Base>>& at) {
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(3 * at.size(), 3 * at.size());
  for (const RelativeFactor& f : factors) {
    const int ends[2] = {f.from, f.to};
    Eigen::Matrix3d j[2];
    for (int end = 0; end < 2; ++end)
      for (int k = 0; k < 3; ++k) {
        constexpr double kStep = 1e-5;
        const auto moved = [&](double by) {
          const auto& p = at[ends[end]];
          const Transform2<Map, Base> q(p.x_m() + (k == 0 ? by : 0.0), p.y_m() + (k == 1 ? by : 0.0),
                                        p.yaw_rad() + (k == 2 ? by : 0.0));
          return end == 0 ? relative_error(f, q, at[f.to]) : relative_error(f, at[f.from], q);
        };
        j[end].col(k) = (moved(kStep) - moved(-kStep)) / (2.0 * kStep);
      }
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b)
        hessian.block<3, 3>(3 * ends[a], 3 * ends[b]) += j[a].transpose() * f.information * j[b];
  }
  const auto n = hessian.rows() - 3;
  return hessian.bottomRightCorner(n, n).inverse();
}

/// The largest differences of one trial.
struct Difference {
  double pose = 0.0;         ///< m and rad
  double pose_sigmas = 0.0;  ///< in the oracle's sigmas
  double sigma_share = 0.0;  ///< of the sigmas themselves
  std::vector<double> published_sigmas, published_share;
};

Difference compare(const Trial& trial) {
  const int count = static_cast<int>(trial.building.truth.size());
  std::vector<SolvedLandmark> solved(kMost);
  (void)solve_landmarks(trial.graph, count, solved.data());
  std::vector<Transform2<Map, Base>> oracle;
  for (const Displacement& truth : trial.building.truth) oracle.push_back(transform(truth));
  GraphOptions thorough;
  thorough.max_iterations = 200;
  thorough.function_tolerance = 1e-15;
  EXPECT_TRUE(optimise_graph(oracle, trial.factors, {}, thorough));
  const Eigen::MatrixXd covariance = oracle_covariance(trial.factors, oracle);
  Difference worst;
  for (int i = 1; i < count; ++i) {
    const ScalarPose published = landmark_position(trial.published, count, 0, i);
    const Displacement& p = solved[i].pose;
    const double apart[3] = {p.x_m - oracle[i].x_m(), p.y_m - oracle[i].y_m(),
                             wrap_angle(p.yaw_rad - oracle[i].yaw_rad())};
    for (int k = 0; k < 3; ++k) {
      const double sigma = std::sqrt(covariance(3 * (i - 1) + k, 3 * (i - 1) + k));
      worst.pose = std::max(worst.pose, std::abs(apart[k]));
      worst.pose_sigmas = std::max(worst.pose_sigmas, std::abs(apart[k]) / sigma);
      worst.sigma_share = std::max(worst.sigma_share,
                                   std::abs(std::sqrt(solved[i].uncertainty.covariance(k, k)) / sigma - 1.0));
    }
    const double sigma_m = std::sqrt(0.5 * covariance.block<2, 2>(3 * (i - 1), 3 * (i - 1)).trace());
    worst.published_sigmas.push_back(
        std::hypot(published.motion.x_m - oracle[i].x_m(), published.motion.y_m - oracle[i].y_m()) / sigma_m);
    worst.published_share.push_back(std::sqrt(published.uncertainty.position_m2) / sigma_m);
  }
  return worst;
}

Difference over_random_graphs(int trials, bool linear) {
  std::mt19937 random(linear ? 3 : 5);
  Difference all;
  for (int i = 0; i < trials; ++i) {
    const auto trial = make_trial(i, linear, random);
    const Difference d = compare(*trial);
    all.pose = std::max(all.pose, d.pose);
    all.pose_sigmas = std::max(all.pose_sigmas, d.pose_sigmas);
    all.sigma_share = std::max(all.sigma_share, d.sigma_share);
    all.published_sigmas.insert(all.published_sigmas.end(), d.published_sigmas.begin(),
                                d.published_sigmas.end());
    all.published_share.insert(all.published_share.end(), d.published_share.begin(), d.published_share.end());
  }
  std::printf(
      "%s: full form at most %.1e m or rad, %.1e sigma off, sigma by %.1e; published form's position %.2f "
      "sigma off "
      "in the median, its sigma %.2f of the right one\n",
      linear ? "linear" : "not linear", all.pose, all.pose_sigmas, all.sigma_share,
      median_of(all.published_sigmas), median_of(all.published_share));
  return all;
}

TEST(LandmarkOracle, FullFormEqualsCeresWhereLinear) {
  const Difference d = over_random_graphs(500, true);
  EXPECT_LT(d.pose, 1e-6);
  EXPECT_LT(d.sigma_share, 1e-6);
}

TEST(LandmarkOracle, FullFormIsWithinThreePercentOfASigmaWhereNot) {
  const Difference d = over_random_graphs(500, false);
  EXPECT_LT(d.pose_sigmas, 0.03);
  EXPECT_LT(d.sigma_share, 0.03);
}

TEST(LandmarkOracle, WhatNothingTiesIsUnknown) {
  FullGraph graph;
  PublishedGraph published;
  graph.fuse(1, 2, {{1.0, 0.0, 0.0}, {Matrix3::diagonal(0.1, 0.1, 0.1)}});
  published.fuse(1, 2, {{1.0, 0.0, 0.0}, {0.1, 0.1}});
  SolvedLandmark landmarks[kMost];
  (void)solve_landmarks(graph, 3, landmarks);
  EXPECT_FALSE(landmarks[0].uncertainty.is_unknown());
  EXPECT_TRUE(landmarks[2].uncertainty.is_unknown());
  EXPECT_TRUE(landmark_position(published, 3, 0, 2).uncertainty.is_unknown());
}

}  // namespace
}  // namespace madori::localization::landmarks
