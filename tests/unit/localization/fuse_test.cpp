#include "localization/memory/fuse.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>

namespace madori::localization {
namespace {

using Poses = std::vector<Transform2<Map, Base>>;

RelativeFactor factor(int from, int to, const Transform2<Base, Base>& motion) {
  Eigen::Matrix3d root;
  root << 9.0, 1.0, 0.0, -2.0, 7.0, 1.0, 0.5, 0.0, 12.0;
  return {from, to, motion, root.transpose() * root, false};
}

TEST(Fuse, AFactorReadBackwardsTwiceIsItself) {
  const RelativeFactor f = factor(3, 8, {1.2, -0.7, 2.1});
  const RelativeFactor back = reversed(reversed(f));
  EXPECT_EQ(back.from, 3);
  EXPECT_EQ(back.to, 8);
  EXPECT_NEAR(back.motion.x_m(), 1.2, 1e-12);
  EXPECT_NEAR(back.motion.yaw_rad(), 2.1, 1e-12);
  EXPECT_LT((back.information - f.information).norm(), 1e-3 * f.information.norm());
}

/// The covariance of two chained motions beside that of 20 000 drawn ones.
TEST(Fuse, ErrorsOfChainedMotionsAddAsTheyDoWhenDrawn) {
  const RelativeFactor a = factor(0, 1, {2.0, 0.5, 0.8});
  const RelativeFactor b = factor(1, 2, {-1.0, 3.0, -0.4});
  const Eigen::Matrix3d scale = 0.01 * Eigen::Matrix3d::Identity();  // small errors: first order holds
  const auto root = [&](const RelativeFactor& f) {
    return Eigen::Matrix3d(Eigen::Matrix3d(scale * f.information.inverse()).llt().matrixL());
  };
  std::mt19937 engine(4);
  std::normal_distribution<double> normal;
  const auto drawn = [&](const RelativeFactor& f) {
    const Eigen::Vector3d e = root(f) * Eigen::Vector3d(normal(engine), normal(engine), normal(engine));
    return Transform2<Base, Base>(f.motion.x_m() + e[0], f.motion.y_m() + e[1], f.motion.yaw_rad() + e[2]);
  };
  const RelativeFactor both = chained(a, b);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const Transform2<Base, Base> t = drawn(a) * drawn(b);
    const Eigen::Vector3d e(t.x_m() - both.motion.x_m(), t.y_m() - both.motion.y_m(),
                            wrap_angle(t.yaw_rad() - both.motion.yaw_rad()));
    sum += e * e.transpose() / kDraws;
  }
  const Eigen::Matrix3d expected = scale * both.information.inverse();
  EXPECT_LT((sum - expected).norm(), 0.05 * expected.norm());
}

TEST(Fuse, TwoMeasurementsMeetAtTheirWeightedMean) {
  RelativeFactor a{0, 1, {1.0, 0.0, 0.1}, 100.0 * Eigen::Matrix3d::Identity(), false};
  RelativeFactor b{0, 1, {2.0, 0.0, 0.2}, 300.0 * Eigen::Matrix3d::Identity(), true};
  const RelativeFactor f = merged(a, b);
  EXPECT_NEAR(f.motion.x_m(), 1.75, 1e-6);
  EXPECT_NEAR(f.motion.yaw_rad(), 0.175, 1e-6);
  EXPECT_FALSE(f.loop);
  EXPECT_GT(f.information(0, 0), 380.0);
}

/// A ring of poses with one taken out: the others are solved to where the whole ring puts them.
TEST(Fuse, TakingOutAPoseLeavesTheOthersWhereTheyWere) {
  Poses truth;
  Poses start;
  std::vector<RelativeFactor> factors;
  std::mt19937 engine(5);
  std::normal_distribution<double> noise(0.0, 0.02);
  Transform2<Map, Base> at;
  for (int i = 0; i < 12; ++i) {
    truth.push_back(at);
    at = at * Transform2<Base, Base>(1.0, 0.1, kPi / 6.0);
  }
  for (int i = 0; i < 12; ++i) {
    const int next = (i + 1) % 12;
    const Transform2<Base, Base> t =
        truth[static_cast<std::size_t>(i)].inverse() * truth[static_cast<std::size_t>(next)];
    const Transform2<Base, Base> measured(t.x_m() + noise(engine), t.y_m() + noise(engine),
                                          t.yaw_rad() + noise(engine));
    factors.push_back({i, next, measured, 2500.0 * Eigen::Matrix3d::Identity(), false});
  }
  Poses whole = truth;
  ASSERT_TRUE(optimise_graph(whole, factors, {}, {50, 3.0}));
  ASSERT_TRUE(take_out(5, whole, factors));
  EXPECT_EQ(factors.size(), 11u);
  for (const RelativeFactor& f : factors) EXPECT_TRUE(f.from != 5 && f.to != 5);
  Poses rest = truth;
  ASSERT_TRUE(optimise_graph(rest, factors, {}, {50, 3.0}));
  for (std::size_t i = 0; i < 12; ++i) {
    if (i == 5) continue;
    EXPECT_LT(distance_m(rest[i].translation(), whole[i].translation()), 0.005) << i;
  }
}

TEST(Fuse, ALoopThatContradictsIsForgottenAndNotHandedOn) {
  Poses poses;
  std::vector<RelativeFactor> factors;
  for (int i = 0; i < 5; ++i) {
    poses.emplace_back(i, 0.0, 0.0);
    if (i > 0) factors.push_back({i - 1, i, {1.0, 0.0, 0.0}, 1e4 * Eigen::Matrix3d::Identity(), false});
  }
  factors.push_back({0, 2, {9.0, 4.0, 1.0}, 1e4 * Eigen::Matrix3d::Identity(), true});
  ASSERT_TRUE(take_out(2, poses, factors));
  ASSERT_EQ(factors.size(), 3u);
  for (const RelativeFactor& f : factors) EXPECT_FALSE(f.loop);
}

}  // namespace
}  // namespace madori::localization
