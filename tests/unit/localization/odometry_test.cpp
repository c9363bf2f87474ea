#include <gtest/gtest.h>

#include <random>

#include "localization/motion_model/odometry_model.hpp"
#include "localization/motion_model/odometry_track.hpp"

namespace madori::localization {
namespace {

/// A second of driving as the wheels report it, in ten pieces.
OdometryStep reckoned(const OdometryModel& model, double distance_m, double turn_rad) {
  OdometryStep step;
  for (int i = 0; i < 10; ++i) model.extend(step, {distance_m / 10.0, 0.0, turn_rad / 10.0});
  return step;
}

TEST(OdometryModel, LearnsABadWheelAndABadTrack) {
  constexpr double kBiasRadPerM = 0.06, kTurnShare = -0.04, kDistanceShare = 0.03;
  OdometryModel model;
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> distance(-0.2, 1.0), turn(-0.6, 0.6);
  std::normal_distribution<double> noise;
  for (int i = 0; i < 400; ++i) {
    const double d = distance(engine), a = turn(engine);
    const OdometryStep step = reckoned(model, d, a);
    const double true_turn = a * (1.0 + kTurnShare) + d * kBiasRadPerM + 0.005 * noise(engine);
    const OdometryModel exact;
    const double chord = (1.0 + kDistanceShare) *
                         std::hypot(reckoned(exact, d, a).motion.x_m(), reckoned(exact, d, a).motion.y_m());
    const double half = 0.5 * true_turn;
    model.learn(
        step, {std::copysign(chord, d) * std::cos(half), std::copysign(chord, d) * std::sin(half), true_turn},
        0.01, 0.005);
  }
  EXPECT_NEAR(model.systematic()[0], kTurnShare, 0.01);
  EXPECT_NEAR(model.systematic()[1], kBiasRadPerM, 0.005);
  EXPECT_NEAR(model.systematic()[2], kDistanceShare, 0.01);
  const OdometryStep step = reckoned(model, 1.0, 0.3);
  EXPECT_NEAR(step.motion.yaw_rad(), 0.3 * (1.0 + kTurnShare) + kBiasRadPerM, 0.008);
}

TEST(OdometryModel, UncertaintyGrowsWithThePathNotWithTheNumberOfReadings) {
  const OdometryModel model;
  OdometryStep coarse, fine;
  for (int i = 0; i < 10; ++i) model.extend(coarse, {0.1, 0.0, 0.02});
  for (int i = 0; i < 100; ++i) model.extend(fine, {0.01, 0.0, 0.002});
  EXPECT_NEAR(fine.covariance(0, 0) / coarse.covariance(0, 0), 1.0, 0.2);
  EXPECT_GT(coarse.covariance(1, 1), 0.0);
  const OdometryStep standing = [&] {
    OdometryStep s;
    model.extend(s, {});
    return s;
  }();
  EXPECT_TRUE(standing.covariance.isZero());
}

TEST(OdometryTrack, InterpolatesBetweenReadingsAndRefusesLateOnes) {
  OdometryTrack track;
  EXPECT_TRUE(track.add({stamp_from_seconds(1.0), {0.0, 0.0, 0.0}}));
  EXPECT_TRUE(track.add({stamp_from_seconds(2.0), {1.0, 0.0, 0.2}}));
  EXPECT_FALSE(track.add({stamp_from_seconds(1.5), {9.0, 0.0, 0.0}}));
  EXPECT_FALSE(track.add({stamp_from_seconds(3.0), {std::nan(""), 0.0, 0.0}}));
  ASSERT_TRUE(track.at(stamp_from_seconds(1.5)));
  EXPECT_NEAR(track.at(stamp_from_seconds(1.5))->odom_from_base.x_m(), 0.5, 1e-9);
  EXPECT_FALSE(track.at(stamp_from_seconds(4.0)));
  const OdometryModel model;
  const OdometryStep step = track.between(stamp_from_seconds(1.25), stamp_from_seconds(1.75), model);
  EXPECT_NEAR(step.motion.yaw_rad(), 0.1, 1e-9);
  EXPECT_NEAR(step.distance_m, 0.5, 1e-9);
}

TEST(OdometryTrack, SilentWheelsAreCarriedOnForAMomentAndThenStand) {
  OdometryTrack track;
  for (int i = 0; i <= 100; ++i)  // 10 s at 1 m/s
    track.add({stamp_from_seconds(1.0 + 0.1 * i), {0.1 * i, 0.0, 0.0}});
  const OdometryModel model;
  double driven_m = 0.0;
  for (double t = 11.0; t < 14.0; t += 0.1) {
    const double step_m =
        track.between(stamp_from_seconds(t), stamp_from_seconds(t + 0.1), model).motion.x_m();
    EXPECT_GE(step_m, -1e-9) << "after " << t - 11.0;
    EXPECT_LE(step_m, 0.1 + 1e-9) << "after " << t - 11.0;
    driven_m += step_m;
  }
  EXPECT_NEAR(driven_m, 0.25, 1e-6);
  EXPECT_NEAR(track.between(stamp_from_seconds(0.0), stamp_from_seconds(0.5), model).motion.x_m(), 0.0, 1e-9);
  EXPECT_NEAR(track.between(stamp_from_seconds(0.5), stamp_from_seconds(2.0), model).motion.x_m(), 1.0, 1e-9);
}

}  // namespace
}  // namespace madori::localization
