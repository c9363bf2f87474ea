#include "localization/particle_filter/particle_filter.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "localization/particle_filter/motion_kernel.hpp"
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

class Filter : public testing::Test {
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
    for (std::size_t i = 0; i < count; ++i) particles.add({at(engine_), at(engine_), yaw(engine_)}, 1.0);
    return particles;
  }
};

TEST_F(Filter, LikelihoodIsHighestOnWallsAndClutterFarOff) {
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

TEST_F(Filter, AWallThatMayBeMissingPullsLess) {
  std::vector<double> reliability(walls_.size(), 1.0);
  reliability[0] = 0.1;
  const LikelihoodField doubtful(walls_, BeamModel{}, 0.05, reliability);
  EXPECT_LT(doubtful.counts({7.0, 0.0}), 200);
  EXPECT_GE(doubtful.counts({20.0, 6.0}), 250);
}

TEST_F(Filter, NearReturnsTellLess) {
  EXPECT_LT(field_.information(0.5), 0.95 * field_.information(10.0));
  EXPECT_LE(field_.information(60.0), 1.01);
  EXPECT_GT(field_.information(0.1), 0.3);
}

TEST_F(Filter, SensorKernelIsTheSameVectorisedAndScalar) {
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

TEST_F(Filter, SensorKernelIsWhatTheFieldSays) {
  const ScanPoints scan = scan_from({4.0, 5.0, 0.3});
  const BeamBlocks beams(scan, field_);
  Particles particles;
  std::normal_distribution<double> n(0.0, 0.05);
  for (int i = 0; i < 100; ++i)
    particles.add({4.0 + n(engine_), 5.0 + n(engine_), 0.3 + 0.2 * n(engine_)}, 0.01);
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

TEST_F(Filter, NothingSeenWeighsNothing) {
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
  ParticleFilter filter({}, 5);
  Eigen::Matrix3d covariance;
  covariance << 0.04, 0.01, 0.002, 0.01, 0.09, -0.003, 0.002, -0.003, 0.0025;
  filter.start_at({10.0, -5.0, 1.0}, covariance, kCount);
  const ParticleEstimate e = filter.estimate();
  EXPECT_NEAR(e.map_from_base.x_m(), 10.0, 4 * 0.2 / std::sqrt(kCount));
  EXPECT_NEAR(e.map_from_base.y_m(), -5.0, 4 * 0.3 / std::sqrt(kCount));
  EXPECT_LT((e.covariance - covariance).cwiseAbs().maxCoeff(), 0.0015);
  std::map<int, int> within;  // sigmas of x
  for (const float x : filter.particles().x_m)
    for (int k = 1; k <= 4; ++k) within[k] += std::abs(x) < 0.2F * static_cast<float>(k);
  EXPECT_NEAR(within[1] / double{kCount}, 0.6827, 0.005);
  EXPECT_NEAR(within[2] / double{kCount}, 0.9545, 0.003);
  EXPECT_NEAR(within[3] / double{kCount}, 0.9973, 0.001);
  EXPECT_LT(within[4], static_cast<int>(kCount));  // it has tails
}

TEST(Resampling, TakesEachParticleInProportion) {
  Particles in;
  const std::vector<double> weights{0.05, 0.5, 0.0, 0.3, 0.15};
  for (std::size_t i = 0; i < weights.size(); ++i) in.add({static_cast<double>(i), 0.0, 0.0}, weights[i]);
  constexpr int kRounds = 1000;
  constexpr std::size_t kCount = 7;
  std::vector<double> mean(weights.size());
  for (int round = 0; round < kRounds; ++round) {
    Particles out;
    resample(in, kCount, (round + 0.5) / kRounds, out);
    ASSERT_EQ(out.size(), kCount);
    std::vector<int> taken(weights.size());
    for (const float x : out.x_m) ++taken[static_cast<std::size_t>(x)];
    for (std::size_t i = 0; i < weights.size(); ++i) {
      EXPECT_GE(taken[i], std::floor(kCount * weights[i] - 1e-5));
      EXPECT_LE(taken[i], std::ceil(kCount * weights[i] + 1e-5));
      mean[i] += taken[i] / double{kRounds};
    }
  }
  for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_NEAR(mean[i], kCount * weights[i], 0.005);
}

TEST(Resampling, KldNumberIsTheQuantileOfChiSquare) {
  // chi-square quantiles at 99 %: 10 degrees 23.209, 100 degrees 135.807; n = quantile / (2 epsilon)
  const KldOptions options;
  EXPECT_NEAR(static_cast<double>(kld_number(11, options)), 23.209 / 0.1, 2.0);
  EXPECT_NEAR(static_cast<double>(kld_number(101, options)), 135.807 / 0.1, 3.0);
  EXPECT_EQ(kld_number(1, options), 1U);
}

TEST(Resampling, BinsAreCountedAsASetWould) {
  std::mt19937 engine(5);
  std::normal_distribution<float> n(0.0F, 2.0F);
  BinCounter counter;
  const KldOptions options{.bin_m = 0.5, .bin_rad = 0.4};
  for (int round = 0; round < 20; ++round) {
    Particles p;
    p.resize(500);
    std::set<std::array<int, 3>> bins;
    for (std::size_t i = 0; i < p.size(); ++i) {
      p.x_m[i] = std::abs(n(engine));
      p.y_m[i] = std::abs(n(engine));
      p.yaw_rad[i] = std::fmod(std::abs(n(engine)), 6.0F);
      p.weight[i] = i < 450 ? 1.0F / 450.0F : 0.0F;
      if (i < 450)
        bins.insert({static_cast<int>(p.x_m[i] / 0.5F), static_cast<int>(p.y_m[i] / 0.5F),
                     static_cast<int>(p.yaw_rad[i] * static_cast<float>(1.0 / 0.4))});
    }
    EXPECT_EQ(counter.count(p, options), bins.size());
  }
}

TEST_F(Filter, BeamsDoNotPassThroughWallsAtTheTruth) {
  for (int i = 0; i < 50; ++i) {
    const Pose truth = test::random_pose(walls_, distance_, 0.4, 4.0, engine_);
    EXPECT_LT(share_through_walls(scan_from(truth), distance_, truth), 0.06) << i;
  }
  // Inside the robot cell the same scan would look through its walls.
  EXPECT_GT(share_through_walls(scan_from({6.8, 5.0, 2.0}), distance_, {8.8, 5.6, 2.0}), 0.6);
}

TEST_F(Filter, FollowsADriveAndShrinksItsNumber) {
  ParticleFilterOptions options;
  options.min_particles = 300;
  ParticleFilter filter(options, 3);
  Pose truth(6.5, 2.0, 0.6);
  const Eigen::Matrix3d spread = Eigen::Vector3d(0.25, 0.25, 0.05).asDiagonal();
  filter.start_at({6.8, 1.7, 0.7}, spread, 4000);
  const Transform2<Base, Base> step(0.1, 0.0, 0.02);
  const Eigen::Matrix3d noise = Eigen::Vector3d(1e-4, 1e-5, 1e-4).asDiagonal();
  std::size_t most = 0;
  for (int i = 0; i < 40; ++i) {
    truth = truth * step;
    filter.predict(step, noise);
    EXPECT_GT(filter.correct(scan_from(truth, 0.2), field_, &distance_), 5.0);
    if (filter.resample_if_needed() && most == 0) most = filter.particles().size();
  }
  const ParticleEstimate e = filter.estimate();
  EXPECT_LT(distance_m(e.map_from_base.translation(), truth.translation()), 0.06);
  EXPECT_LT(std::abs(wrap_angle(e.map_from_base.yaw_rad() - truth.yaw_rad())), 0.02);
  EXPECT_LT(filter.particles().size(), 1000U);
  const Eigen::Vector3d error(e.map_from_base.x_m() - truth.x_m(), e.map_from_base.y_m() - truth.y_m(),
                              wrap_angle(e.map_from_base.yaw_rad() - truth.yaw_rad()));
  EXPECT_LT(error.dot(e.covariance.inverse() * error), 16.0);
}

TEST_F(Filter, InjectedParticlesBringTheirShare) {
  ParticleFilter filter({}, 3);
  const Eigen::Matrix3d tight = Eigen::Matrix3d::Identity() * 1e-4;
  filter.start_at({2.0, 2.0, 0.0}, tight, 1000);
  filter.inject({15.0, 4.0, 1.0}, tight, 0.3);
  double there = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < filter.particles().size(); ++i) {
    sum += filter.particles().weight[i];
    if (filter.particles().pose(i).x_m() > 10.0) there += filter.particles().weight[i];
  }
  EXPECT_NEAR(sum, 1.0, 1e-4);
  EXPECT_NEAR(there, 0.3, 1e-4);
}

TEST_F(Filter, TheSameSeedGivesTheSameParticles) {
  const auto run = [&] {
    std::mt19937 engine(1);
    engine_ = engine;
    ParticleFilter filter({}, 99);
    filter.start_at({4.0, 5.0, 0.0}, Eigen::Matrix3d::Identity() * 0.01, 800);
    filter.predict({0.1, 0.0, 0.0}, Eigen::Matrix3d::Identity() * 0.001);
    (void)filter.correct(scan_from({4.1, 5.0, 0.0}), field_);
    filter.resample_if_needed();
    return filter.particles().x_m;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace madori::localization
