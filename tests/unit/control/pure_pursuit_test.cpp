#include "control/pure_pursuit/pure_pursuit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/limits/limits.hpp"
#include "core/angle.hpp"
#include "core/segment_distance.hpp"
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

/// Few points and sharp bends both ways: nothing between two points is nearly one of them.
Path coarse_path() {
  Path path;
  for (const Point2<Map>& p :
       {Point2<Map>{0.0, 0.0}, {1.5, 0.0}, {2.5, 0.6}, {3.1, 0.7}, {4.0, 0.2}, {4.3, -0.6}, {5.5, -1.0}})
    path.points.push_back({p, 0.0, 0.0});
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const Point2<Map>& a = path.points[i > 0 ? i - 1 : 0].position;
    const Point2<Map>& b = path.points[i > 0 ? i : 1].position;
    path.points[i].heading_rad = std::atan2(b.y_m - a.y_m, b.x_m - a.x_m);
  }
  return path;
}

/// Walked from point to point.
Point2<Map> along(const Path& path, double way_m) {
  std::size_t i = 0;
  for (; i + 2 < path.points.size(); ++i) {
    const double step_m = distance_m(path.points[i].position, path.points[i + 1].position);
    if (way_m <= step_m) break;
    way_m -= step_m;
  }
  const Point2<Map>&a = path.points[i].position, &b = path.points[i + 1].position;
  const double share = way_m / distance_m(a, b);
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m)};
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

TEST(PurePursuit, ItsPlaceIsBesideTheNearestSegmentThatComes) {
  const Path path = coarse_path();
  const TrackedPath tracked(path, {});
  const PathPiece whole = tracked.pieces().front();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-0.5, 6.0), y(-1.5, 1.5);
  for (int run = 0; run < 1000; ++run) {
    const Point2<Map> here{x(random), y(random)};
    const std::size_t hint = random() % (path.points.size() - 1);
    const auto segment = [&](std::size_t i) {
      return Segment2<Map>{path.points[i].position, path.points[i + 1].position};
    };
    double nearest_m = 1e9;
    for (std::size_t i = hint; i < path.points.size() - 1; ++i)
      if (tracked.along_m(i) - tracked.along_m(hint) <= 2.0)
        nearest_m = std::min(nearest_m, distance_m(segment(i), here));
    const PathPlace place = tracked.locate(whole, hint, {here.x_m, here.y_m, 0.0});
    EXPECT_NEAR(distance_m(segment(place.index), here), nearest_m, 1e-9);
    const auto [a, b] = segment(place.index);
    const double length_m = distance_m(a, b), forward_m = place.along_m - tracked.along_m(place.index);
    const double ux = (b.x_m - a.x_m) / length_m, uy = (b.y_m - a.y_m) / length_m;
    const Point2<Map> laid{a.x_m + forward_m * ux - place.cross_track_m * uy,
                           a.y_m + forward_m * uy + place.cross_track_m * ux};
    EXPECT_LT(distance_m(laid, here), 1e-9);
  }
}

TEST(PurePursuit, TheArcLeadsThroughThePathOneLookAheadFurther) {
  PursuitOptions options;
  options.min_look_ahead_m = options.max_look_ahead_m = 0.8;
  const Path straight{{{{0.0, 0.0}}, {{3.0, 0.0}}}};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> way(0.1, 2.9), aside(-0.3, 0.3), yaw(-0.5, 0.5);
  for (const Path& path : {coarse_path(), straight})
    for (int run = 0; run < 300; ++run) {
      const Point2<Map> at = along(path, way(random));
      const Transform2<Map, Base> pose(at.x_m, at.y_m + aside(random), yaw(random));
      const auto out = pursue(TrackedPath(path, {}), {0, 0, false, true}, {.map_from_base = pose}, options);
      ASSERT_EQ(out.status, PursuitStatus::Following);
      const auto& [v, w] = out.command;
      const Point2<Base> target = pose.inverse() * along(path, out.along_m + options.min_look_ahead_m);
      EXPECT_NEAR(w * (target.x_m * target.x_m + target.y_m * target.y_m), 2.0 * v * target.y_m, 1e-9)
          << "distance to the circle's centre is the radius";
    }
}

TEST(PurePursuit, BackwardsIsForwardsOfAVehicleThatLooksTheOtherWay) {
  const Path path = bent_path(1.0, kPi);
  Path backwards = path;
  for (PathPoint& point : backwards.points) point.reverse = true;
  const TrackedPath there(path, {}), back(backwards, {});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> way(0.0, 6.0), aside(-0.5, 0.5), yaw(-1.0, 3.0);
  for (int run = 0; run < 300; ++run) {
    const Point2<Map> at = along(path, way(random));
    const Transform2<Map, Base> pose(at.x_m + aside(random), at.y_m + aside(random), yaw(random));
    const PursuitState state{0, 0, false, run % 2 == 0};
    const auto forth = pursue(there, state, {.map_from_base = pose}, {});
    const auto turned =
        pursue(back, state, {.map_from_base = pose * Transform2<Base, Base>(0.0, 0.0, kPi)}, {});
    EXPECT_EQ(turned.status, forth.status);
    EXPECT_NEAR(turned.along_m, forth.along_m, 1e-9);
    EXPECT_NEAR(turned.command.linear_mps, -forth.command.linear_mps, 1e-9);
    EXPECT_NEAR(turned.command.angular_radps, forth.command.angular_radps, 1e-9);
  }
}

/// Moved and turned as a whole, or seen in a mirror, the same is done.
TEST(PurePursuit, IsTheSameAnywhereAndInAMirror) {
  const Path path = bent_path(1.0, kPi);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> way(0.0, 6.0), aside(-0.8, 0.8), yaw(-1.0, 3.0), anywhere(-9.0, 9.0);
  int turned = 0, off_path = 0;
  for (int run = 0; run < 300; ++run) {
    const Point2<Map> at = along(path, way(random));
    const Transform2<Map, Base> pose(at.x_m + aside(random), at.y_m + aside(random), yaw(random));
    const Transform2<Map, Map> shift(anywhere(random), anywhere(random), anywhere(random));
    Path moved = path, mirrored = path;
    for (PathPoint& p : moved.points)
      p.position = shift * p.position, p.heading_rad = wrap_angle(p.heading_rad + shift.yaw_rad());
    for (PathPoint& p : mirrored.points)
      p.position.y_m = -p.position.y_m, p.heading_rad = -p.heading_rad,
      p.curvature_per_m = -p.curvature_per_m;
    const auto out = pursue(TrackedPath(path, {}), {}, {.map_from_base = pose}, {});
    const auto there = pursue(TrackedPath(moved, {}), {}, {.map_from_base = shift * pose}, {});
    const auto left = pursue(TrackedPath(mirrored, {}), {},
                             {.map_from_base = {pose.x_m(), -pose.y_m(), -pose.yaw_rad()}}, {});
    EXPECT_EQ(there.status, out.status);
    EXPECT_NEAR(there.command.linear_mps, out.command.linear_mps, 1e-9);
    EXPECT_NEAR(there.command.angular_radps, out.command.angular_radps, 1e-9);
    EXPECT_EQ(left.status, out.status);
    EXPECT_NEAR(left.command.linear_mps, out.command.linear_mps, 1e-9);
    EXPECT_NEAR(left.command.angular_radps, -out.command.angular_radps, 1e-9);
    turned += out.status == PursuitStatus::Turning ? 1 : 0;
    off_path += out.status == PursuitStatus::OffPath ? 1 : 0;
  }
  EXPECT_GT(turned, 20);
  EXPECT_GT(off_path, 5);
}

TEST(PurePursuit, ATurnIsNoFasterThanItCanBeBrakedToItsHeading) {
  const TrackedPath path(bent_path(1.0, 0.0), {});
  const PursuitOptions options;
  for (const double off_rad : {0.1, 0.2, 0.4}) {
    const auto out = pursue(path, {0, 0, true, true}, {.map_from_base = {0.0, 0.0, -off_rad}}, options);
    const double rate = out.command.angular_radps;
    EXPECT_NEAR(rate * options.speed.reaction_s + rate * rate / (2.0 * options.turn_acceleration_radps2),
                off_rad, 1e-9);
  }
}

TEST(PurePursuit, ATurnOnTheSpotLiesWhereItsPieceBegins) {
  const TrackedPath path(bent_path(1.0, kPi), {});
  const std::size_t last = path.points().size() - 1;
  const auto out = pursue(path, {1, last, true, true}, {.map_from_base = {5.0, 4.0, kPi / 2.0}}, {});
  EXPECT_EQ(out.status, PursuitStatus::Turning);
  EXPECT_EQ(out.along_m, path.length_m());
}

TEST(PurePursuit, TheProfileIsAsFastAsStoppingAtTheEndAllows) {
  Path path;
  for (int i = 0; i <= 40; ++i) path.points.push_back({{0.1 * i, 0.0}});
  const SpeedLimits limits;
  const TrackedPath tracked(path, limits);
  for (std::size_t i = 0; i < path.points.size(); ++i)
    EXPECT_NEAR(
        tracked.speed_at(tracked.pieces().front(), tracked.along_m(i)),
        std::min(limits.max_speed_mps, limits.speed_to_stop_within(tracked.length_m() - tracked.along_m(i))),
        1e-9);
  for (std::size_t i = 20; i < 30; ++i) path.points[i].speed_limit_mps = 0.2;
  const TrackedPath slow(path, limits);
  for (std::size_t i = 0; i < 20; ++i) {
    const double v = slow.speed_at(slow.pieces().front(), slow.along_m(i));
    const double braked =
        std::sqrt(0.2 * 0.2 + 2.0 * limits.deceleration_mps2 * 0.1 * (20.0 - static_cast<double>(i)));
    EXPECT_NEAR(v, std::min(limits.max_speed_mps, braked), 1e-9) << "before a slow stretch";
  }
}

}  // namespace
}  // namespace madori::control
