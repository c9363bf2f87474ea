// Two level scanners at opposite corners, each of which sees what the other one does not.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "app/cycle/cycle.hpp"
#include "tests/support/lidar_models.hpp"

namespace madori::app {
namespace {

const LidarMounting kFrontLeft{0.75, 0.25, 0.15, to_rad(45.0)};
const LidarMounting kRearRight{-0.15, -0.25, 0.15, to_rad(-135.0)};

/// It knows where it stands: at the origin.
struct StandingStill final : PoseSource {
  PoseEstimate on_odometry(const OdometryReading& reading) override {
    return {reading.stamp, {}, Eigen::Matrix3d::Identity() * 1e-6, {LocalizationState::Localized, ""}};
  }
  void on_cloud(const PointCloud<Base>& /*cloud*/, const Transform2<Odom, Base>& /*odom*/) override {}
  void set_pose(const Transform2<Map, Base>& /*pose*/, const PoseSigma& /*sigma*/) override {}
  void search_anew() override {}
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return {}; }
};

/// What a scanner sees of a round room of 6 m and of a leg of 0.2 m in it.
LaserScan scan_of(const LidarModel& lidar, const Point2<Base>& leg, Stamp stamp, std::size_t index) {
  constexpr double kRoomM = 6.0, kLegRadiusM = 0.1;
  const Point2<Lidar> at = lidar.mounting.base_from_lidar().inverse() * leg;
  LaserScan scan;
  scan.stamp = stamp;
  scan.lidar = index;
  scan.angle_min_rad = lidar.from_rad;
  scan.angle_step_rad = lidar.step_rad;
  scan.range_max_m = lidar.range_max_m;
  for (double angle = lidar.from_rad; angle <= lidar.to_rad + 1e-9; angle += lidar.step_rad) {
    const double along = at.x_m * std::cos(angle) + at.y_m * std::sin(angle);
    const double aside = at.x_m * std::sin(angle) - at.y_m * std::cos(angle);
    const bool hit = along > 0.0 && std::abs(aside) < kLegRadiusM;
    scan.ranges_m.push_back(
        static_cast<float>(hit ? along - std::sqrt(kLegRadiusM * kLegRadiusM - aside * aside) : kRoomM));
  }
  return scan;
}

/// The movers of each lidar after 1.6 s in which a leg walks from `from` at 1 m/s to the right. The scans of
/// the first lidar in `order` always come first.
std::vector<std::size_t> movers_after(const Point2<Base>& from, const std::array<std::size_t, 2>& order) {
  CycleConfig config;
  config.lidars = {test::planar_lidar(kFrontLeft), test::planar_lidar(kRearRight)};
  CycleState state(config, std::make_unique<StandingStill>());
  for (int i = 0; i < 40; ++i) {
    CycleInput input;
    input.now = stamp_from_seconds(100.0 + 0.04 * i);
    for (const std::size_t lidar : order) {
      // The one that comes last was measured a little earlier.
      const Stamp stamp = input.now - duration_from_seconds(lidar == order[0] ? 0.04 : 0.045);
      const Point2<Base> leg{from.x_m, from.y_m - 0.04 * i};
      input.scans.push_back(scan_of(config.lidars[lidar], leg, stamp, lidar));
    }
    state = step(std::move(state), input, config).state;
  }
  return {state.movers[0].objects.movers().size(), state.movers[1].objects.movers().size()};
}

TEST(TwoLidars, WhoWalksInTheFieldOfOneIsFollowedThoughTheOtherDoesNotSeeHim) {
  for (const auto& order : {std::array<std::size_t, 2>{0, 1}, std::array<std::size_t, 2>{1, 0}}) {
    const auto ahead_left = movers_after({2.5, 2.5}, order);
    EXPECT_EQ(ahead_left[0], 1U) << "scanner at the front left, first comes " << order[0];
    EXPECT_EQ(ahead_left[1], 0U) << "which does not look there";
    const auto behind_right = movers_after({-1.5, -1.2}, order);
    EXPECT_EQ(behind_right[0], 0U);
    EXPECT_EQ(behind_right[1], 1U) << "scanner at the rear right, first comes " << order[0];
    const auto ahead_right = movers_after({2.5, -0.5}, order);
    EXPECT_EQ(ahead_right[0] + ahead_right[1], 2U) << "both see him";
  }
}

}  // namespace
}  // namespace madori::app
