#include "control/pure_pursuit/pure_pursuit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/limits/limits.hpp"
#include "core/angle.hpp"
#include "tests/support/rolling_vehicle.hpp"

namespace madori::control {
namespace {

constexpr double kStep_s = 0.02;
constexpr double kLag_s = 0.1;

/// Straight on, a quarter circle to the left, straight on; then a turn on the spot.
Path bent_path(double radius_m, double final_heading_rad) {
  Path path;
  for (double x = 0.0; x < 4.0 - 1e-9; x += 0.1) path.points.push_back({{x, 0.0}, 0.0, 0.0});
  for (double a = 0.0; a < kPi / 2.0 - 1e-9; a += kPi / 60.0)
    path.points.push_back(
        {{4.0 + radius_m * std::sin(a), radius_m * (1.0 - std::cos(a))}, a, 1.0 / radius_m});
  for (double y = 0.0; y < 3.0 + 1e-9; y += 0.1)
    path.points.push_back({{4.0 + radius_m, radius_m + y}, kPi / 2.0, 0.0});
  path.points.push_back({path.points.back().position, final_heading_rad, 0.0});
  return path;
}

struct Drive {
  double worst_cross_m = 0.0;
  double sum_cross_m = 0.0;
  double fastest_mps = 0.0;
  int steps = 0;
  PursuitStatus status = PursuitStatus::Following;
  Transform2<Map, Base> end;
};

Drive drive(const TrackedPath& path, Transform2<Map, Base> start, const PursuitInput& input = {},
            const PursuitOptions& options = {}) {
  test::RollingVehicle vehicle(start, kLag_s);
  PursuitState state;
  LimitState limits;
  Drive result;
  for (int still = 0; still < 25 && result.steps < 10'000; ++result.steps) {
    PursuitInput now = input;
    now.map_from_base = vehicle.pose();
    const auto out = pursue(path, state, now, options);
    state = out.state;
    result.status = out.status;
    const auto limited = limit(limits, {.requested = out.command, .step_s = kStep_s}, {});
    limits = limited.state;
    vehicle.move(limited.command, kStep_s);
    result.worst_cross_m = std::max(result.worst_cross_m, std::abs(out.cross_track_m));
    result.sum_cross_m += std::abs(out.cross_track_m);
    result.fastest_mps = std::max(result.fastest_mps, vehicle.speed().linear_mps);
    still = out.status == PursuitStatus::Arrived || out.status == PursuitStatus::OffPath ? still + 1 : 0;
  }
  result.end = vehicle.pose();
  return result;
}

TEST(PurePursuit, FollowsABendAtFullSpeedAndStopsAccurately) {
  const TrackedPath path(bent_path(1.0, kPi), {});
  const Drive result = drive(path, {0.0, 0.0, 0.0});
  EXPECT_EQ(result.status, PursuitStatus::Arrived);
  EXPECT_GT(result.fastest_mps, 0.95);
  EXPECT_LT(result.worst_cross_m, 0.06);
  EXPECT_LT(result.sum_cross_m / result.steps, 0.015);
  EXPECT_LT(distance_m(result.end.translation(), Point2<Map>{5.0, 4.0}), 0.01);
  EXPECT_LT(std::abs(wrap_angle(result.end.yaw_rad() - kPi)), to_rad(0.6));
}

TEST(PurePursuit, TurnsFirstWhenItLooksTheOtherWay) {
  const TrackedPath path(bent_path(1.0, 0.0), {});
  const auto out = pursue(path, {}, {.map_from_base = {0.0, 0.0, kPi - 0.1}}, {});
  EXPECT_EQ(out.status, PursuitStatus::Turning);
  EXPECT_EQ(out.command.linear_mps, 0.0);
  EXPECT_LT(out.command.angular_radps, -0.5);
  const auto kept = pursue(path, {}, {.map_from_base = {0.0, 0.0, kPi - 0.1}, .turn_free = false}, {});
  EXPECT_EQ(kept.command, VelocityCommand{});
}

TEST(PurePursuit, ComesBackToThePathFromTheSide) {
  const TrackedPath path(bent_path(1.0, kPi / 2.0), {});
  const Drive result = drive(path, {0.0, 0.3, 0.2});
  EXPECT_EQ(result.status, PursuitStatus::Arrived);
  EXPECT_LT(distance_m(result.end.translation(), Point2<Map>{5.0, 4.0}), 0.01);
}

TEST(PurePursuit, GivesUpFarFromThePath) {
  const TrackedPath path(bent_path(1.0, 0.0), {});
  const auto out = pursue(path, {}, {.map_from_base = {1.0, 0.8, 0.0}}, {});
  EXPECT_EQ(out.status, PursuitStatus::OffPath);
  EXPECT_EQ(out.command, VelocityCommand{});
}

TEST(PurePursuit, StopsBeforeAnObstacleAndCreepsNowhere) {
  const TrackedPath path(bent_path(1.0, 0.0), {});
  EXPECT_EQ(pursue(path, {}, {.free_distance_m = 0.0}, {}).command.linear_mps, 0.0);
  const double speed = pursue(path, {}, {.free_distance_m = 0.5}, {}).command.linear_mps;
  const SpeedLimits limits;
  EXPECT_NEAR(speed * limits.reaction_s + speed * speed / (2.0 * limits.deceleration_mps2), 0.5, 1e-9);
}

TEST(PurePursuit, AnUnsurePoseSlowsDown) {
  const TrackedPath path(bent_path(1.0, 0.0), {});
  const PursuitOptions options;
  const auto speed = [&](double sigma_m) {
    return pursue(path, {}, {.map_from_base = {1.0, 0.0, 0.0}, .position_sigma_m = sigma_m}, options)
        .command.linear_mps;
  };
  EXPECT_DOUBLE_EQ(speed(0.02), 1.0);
  EXPECT_LT(speed(0.2), 0.6);
  EXPECT_NEAR(speed(5.0), options.unsure_speed_mps, 1e-12);
}

TEST(PurePursuit, TheSpeedProfileKeepsLegLimitsAndCurves) {
  Path path = bent_path(0.5, 0.0);
  for (auto& point : path.points)
    if (point.position.x_m < 1.0) point.speed_limit_mps = 0.3;
  const SpeedLimits limits;
  const TrackedPath tracked(path, limits);
  const PathPiece piece = tracked.pieces()[0];
  EXPECT_DOUBLE_EQ(tracked.speed_at(piece, 0.5), 0.3);
  EXPECT_LE(tracked.speed_at(piece, 4.3), std::sqrt(limits.lateral_acceleration_mps2 * 0.5) + 1e-12);
  EXPECT_EQ(tracked.speed_at(piece, tracked.length_m()), 0.0);
  EXPECT_EQ(tracked.pieces().size(), 2U);
}

TEST(PurePursuit, WhoLooksAwayFromThePathDoesNotDriveOn) {
  const TrackedPath path(bent_path(1.0, kPi / 2.0), {});
  const PursuitState on_way{0, 10, false, true};
  for (const double yaw_rad : {kPi, 2.5, -1.7}) {
    const auto out = pursue(path, on_way, {.map_from_base = {1.0, 0.01, yaw_rad}}, {});
    EXPECT_EQ(out.status, PursuitStatus::OffPath) << yaw_rad;
    EXPECT_EQ(out.command, VelocityCommand{});
  }
  EXPECT_EQ(pursue(path, on_way, {.map_from_base = {1.0, 0.01, 1.3}}, {}).status, PursuitStatus::Following);
}

TEST(PurePursuit, ComingBackToThePathKeepsTheLateralAcceleration) {
  const TrackedPath path(bent_path(1.0, kPi / 2.0), {});
  const PursuitOptions options;
  for (const double aside_m : {0.05, 0.1, 0.2, 0.4}) {
    const auto out =
        pursue(path, {0, 10, false, true}, {.map_from_base = {1.0, aside_m, 0.0}}, options).command;
    EXPECT_LE(std::abs(out.linear_mps * out.angular_radps), options.speed.lateral_acceleration_mps2 + 1e-9)
        << aside_m;
    EXPECT_GT(out.linear_mps, 0.1);
  }
}

}  // namespace
}  // namespace madori::control
