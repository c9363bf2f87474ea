#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "localization/particle_filter/beam_path.hpp"
#include "localization/particle_filter/motion_kernel.hpp"
#include "localization/particle_filter/resampling.hpp"
#include "localization/particle_filter/sensor_kernel.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// Every instruction set of this processor in turn; all of them again at the end.
template <class Check>
void on_every_target(Check&& check) {
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    hwy::SetSupportedTargetsForTest(targets & -targets);
    check(hwy::TargetName(targets & -targets));
  }
  hwy::SetSupportedTargetsForTest(0);
}

class SensorKernel : public testing::Test {
 protected:
  const mapping::Walls walls_ = test::laboratory_hall();
  const mapping::DistanceField distance_{walls_};
  const LikelihoodField field_{walls_, BeamModel{}};
  std::mt19937 engine_{11};

  ScanPoints scan_from(const Pose& pose, double clutter = 0.0) {
    test::ScanSettings settings;
    settings.range_sigma_m = 0.01;
    settings.clutter = clutter;
    return scan_points(test::simulate_scan(walls_, pose, settings, engine_), {});
  }
  Particles scattered(std::size_t count) {
    std::uniform_real_distribution<double> at(-12.0, 30.0);  // some of them off the table
    std::uniform_real_distribution<double> yaw(-20.0, 20.0);
    Particles particles;
    particles.origin = {3.0, -2.0};
    for (std::size_t i = 0; i < count; ++i) particles.add({at(engine_), at(engine_), yaw(engine_)});
    return particles;
  }
};

TEST_F(SensorKernel, LikelihoodIsHighestOnWallsAndClutterFarOff) {
  EXPECT_GE(field_.counts({7.0, 0.0}), 245);
  EXPECT_EQ(field_.counts({7.0, 1.5}), 0);
  EXPECT_EQ(field_.counts({-100.0, 1.5}), 0);
  int last = 256;
  for (int i = 0; i < 7; ++i) {
    const double d = 0.06 * i;
    EXPECT_LE(field_.counts({7.0, d}), last);
    last = field_.counts({7.0, d});
  }
}

TEST_F(SensorKernel, AWallThatMayBeMissingPullsLess) {
  std::vector<double> reliability(walls_.size(), 1.0);
  reliability[0] = 0.1;
  const LikelihoodField doubtful(walls_, BeamModel{}, 0.05, reliability);
  EXPECT_LT(doubtful.counts({7.0, 0.0}), 200);
  EXPECT_GE(doubtful.counts({20.0, 6.0}), 250);
}

TEST_F(SensorKernel, NearReturnsTellLess) {
  EXPECT_LT(field_.information(0.5), 0.95 * field_.information(10.0));
  EXPECT_LE(field_.information(60.0), 1.01);
  EXPECT_GT(field_.information(0.1), 0.3);
}

TEST_F(SensorKernel, SensorKernelIsTheSameVectorisedAndScalar) {
  for (const int keep : {1, 31, 32, 33, 535}) {
    ScanPoints scan = scan_from({4.0, 5.0, 0.3}, 0.2);
    for (auto* array : {&scan.x_m, &scan.y_m}) array->resize(std::min<std::size_t>(array->size(), keep));
    std::uniform_real_distribution<float> weight(0.0F, 1.0F);
    for (std::size_t i = 0; i < scan.size(); ++i) scan.weight.push_back(weight(engine_));
    const BeamBlocks beams(scan, field_);
    const Particles particles = scattered(300);
    std::vector<std::uint32_t> scalar(particles.size()), vector(particles.size());
    sum_counts_scalar(particles, beams, field_, scalar);
    on_every_target([&](const char* target) {
      sum_counts(particles, beams, field_, vector);
      EXPECT_EQ(vector, scalar) << target << ", " << keep << " beams";
    });
  }
}

TEST_F(SensorKernel, SensorKernelIsWhatTheFieldSays) {
  const ScanPoints scan = scan_from({4.0, 5.0, 0.3});
  const BeamBlocks beams(scan, field_);
  Particles particles;
  std::normal_distribution<double> n(0.0, 0.05);
  for (int i = 0; i < 100; ++i) particles.add({4.0 + n(engine_), 5.0 + n(engine_), 0.3 + 0.2 * n(engine_)});
  std::vector<std::uint32_t> sums(particles.size());
  sum_counts(particles, beams, field_, sums);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    double exact = 0.0;
    for (std::size_t k = 0; k < scan.size(); ++k)
      exact += field_.information(std::hypot(scan.x_m[k], scan.y_m[k])) *
               field_.counts(particles.pose(i) * scan.point(k));
    // A beam in 16 bits may fall into the neighbouring cell; over all beams that evens out.
    EXPECT_NEAR(sums[i] / double{BeamBlocks::kFullWeight}, exact, 0.02 * 255 * beams.total_weight());
  }
}

TEST_F(SensorKernel, NothingSeenWeighsNothing) {
  const Particles particles = scattered(10);
  std::vector<std::uint32_t> sums(10, 7);
  sum_counts(particles, BeamBlocks({}, field_), field_, sums);
  EXPECT_EQ(sums, std::vector<std::uint32_t>(10, 0));
  ScanPoints wild;
  wild.add(std::numeric_limits<double>::quiet_NaN(), 1.0);
  wild.add(1e9, 1.0);
  EXPECT_EQ(BeamBlocks(wild, field_).beams(), 0U);
}

TEST(MotionKernel, IsTheSameVectorisedAndScalar) {
  MotionStep step{{0.1F, 0.02F, 0.3F}, {0.1F, 0.02F, 0.05F, 0.01F, 0.0F, 0.2F}, 123, 456};
  std::vector<float> x(1003), y(1003), yaw(1003);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto n = static_cast<float>(i);
    x[i] = 0.01F * n;
    y[i] = -0.02F * n;
    yaw[i] = 0.05F * n - 20.0F;
  }
  auto x1 = x, y1 = y, yaw1 = yaw;
  move_particles_scalar(step, x1.data(), y1.data(), yaw1.data(), x1.size());
  on_every_target([&](const char* target) {
    auto x2 = x, y2 = y, yaw2 = yaw;
    move_particles(step, x2.data(), y2.data(), yaw2.data(), x2.size());
    EXPECT_EQ(x1, x2) << target;
    EXPECT_EQ(y1, y2) << target;
    EXPECT_EQ(yaw1, yaw2) << target;
  });
}

TEST(MotionKernel, TurnsAsSineAndCosineDo) {
  const MotionStep ahead{{1.0F, 0.5F, 0.0F}, {}, 1, 2};
  for (int i = -800; i < 800; ++i) {
    const float yaw = 0.0371F * static_cast<float>(i);
    float x = 0.0F, y = 0.0F, t = yaw;
    move_particles(ahead, &x, &y, &t, 1);
    EXPECT_NEAR(x, std::cos(yaw) - 0.5 * std::sin(yaw), 4e-6);
    EXPECT_NEAR(y, std::sin(yaw) + 0.5 * std::cos(yaw), 4e-6);
    EXPECT_EQ(t, yaw);
  }
}

TEST(MotionKernel, DrawsTheAskedNormal) {
  constexpr std::size_t kCount = 200'000;
  Eigen::Matrix3d covariance;
  covariance << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.0025;
  const Eigen::Matrix3f l = Eigen::Matrix3d(covariance.llt().matrixL()).cast<float>();
  const MotionStep step{
      {1.0F, -0.5F, 0.1F}, {l(0, 0), l(1, 0), l(1, 1), l(2, 0), l(2, 1), l(2, 2)}, 123, 456};
  std::vector<float> x(kCount), y(kCount), yaw(kCount);
  move_particles(step, x.data(), y.data(), yaw.data(), kCount);
  Eigen::MatrixXd drawn(kCount, 3);
  for (Eigen::Index i = 0; i < drawn.rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    drawn.row(i) << double{x[k]}, double{y[k]}, double{yaw[k]};
  }
  const Eigen::RowVector3d mean = drawn.colwise().mean();
  EXPECT_NEAR(mean.x(), 1.0, 4 * 0.2 / std::sqrt(kCount));
  EXPECT_NEAR(mean.y(), -0.5, 4 * 0.3 / std::sqrt(kCount));
  EXPECT_NEAR(mean.z(), 0.1, 4 * 0.05 / std::sqrt(kCount));
  const Eigen::MatrixXd off = drawn.rowwise() - mean;
  EXPECT_LT((off.transpose() * off / kCount - covariance).cwiseAbs().maxCoeff(), 0.0015);
  std::map<int, int> within;  // sigmas of x
  for (const float v : x)
    for (int k = 1; k <= 4; ++k) within[k] += std::abs(v - 1.0F) < 0.2F * static_cast<float>(k);
  EXPECT_NEAR(within[1] / double{kCount}, 0.6827, 0.005);
  EXPECT_NEAR(within[2] / double{kCount}, 0.9545, 0.003);
  EXPECT_NEAR(within[3] / double{kCount}, 0.9973, 0.001);
  EXPECT_LT(within[4], static_cast<int>(kCount));  // it has tails
}

TEST(Resampling, TakesEachParticleInProportion) {
  const std::vector<double> weights{0.05, 0.5, 0.0, 0.3, 0.15};
  constexpr int kRounds = 1000;
  constexpr std::size_t kCount = 7;
  std::vector<double> mean(weights.size());
  for (int round = 0; round < kRounds; ++round) {
    std::vector<int> taken(weights.size());
    draw_systematically(weights, kCount, (round + 0.5) / kRounds, [&](std::size_t i) { ++taken[i]; });
    EXPECT_EQ(std::accumulate(taken.begin(), taken.end(), std::size_t{0}), kCount);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_GE(taken[i], std::floor(kCount * weights[i] - 1e-5));
      EXPECT_LE(taken[i], std::ceil(kCount * weights[i] + 1e-5));
      mean[i] += taken[i] / double{kRounds};
    }
  }
  for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(mean[i], kCount * weights[i], 0.005);
}

TEST_F(SensorKernel, BeamsDoNotPassThroughWallsAtTheTruth) {
  for (int i = 0; i < 50; ++i) {
    const Pose truth = test::random_pose(walls_, distance_, 0.4, 4.0, engine_);
    EXPECT_LT(share_through_walls(scan_from(truth), distance_, truth), 0.06) << i;
  }
  // Inside the robot cell the same scan would look through its walls.
  EXPECT_GT(share_through_walls(scan_from({6.8, 5.0, 2.0}), distance_, {8.8, 5.6, 2.0}), 0.6);
}

}  // namespace
}  // namespace madori::localization
