#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <complex>
#include <vector>

#include "control/diff_drive/kinematics.hpp"
#include "control/diff_drive/odometry.hpp"
#include "core/result.hpp"

namespace madori::control {
namespace {

constexpr std::uint32_t kPeriodUs = 10'000;

/// Status frames of a drive whose wheels stand at these angles every 10 ms.
class Wheels {
 public:
  wire::Status turn(double left_rad, double right_rad) {
    left_ += left_rad, right_ += right_rad;
    status_.sequence++;
    status_.time_us += kPeriodUs;
    read(left_, status_.left_angle, status_.left_turns);
    read(right_, status_.right_angle, status_.right_turns);
    return status_;
  }

 private:
  static void read(double angle_rad, std::uint16_t& angle, std::int16_t& turns) {
    const auto counts = std::llround(angle_rad / (2.0 * kPi) * wire::kCountsPerTurn);
    angle = static_cast<std::uint16_t>(counts & (wire::kCountsPerTurn - 1));
    turns = static_cast<std::int16_t>(counts >> 14);
  }
  wire::Status status_{.sequence = 0xFFF0, .time_us = 0xFFFF0000U};
  double left_ = 3.0, right_ = -3.0;
};

TEST(ArcStep, IsExactOnCircles) {
  const WheelGeometry wheels{0.1, 0.1, 0.25};
  Transform2<Odom, Base> pose;
  for (int i = 0; i < 8; ++i) pose = pose * arc_step(wheels, 5.0 * kPi / 4.0, 15.0 * kPi / 4.0);
  EXPECT_NEAR(pose.x_m(), 0.0, 1e-12);  // 1 m radius, 2 pi in all
  EXPECT_NEAR(pose.y_m(), 0.0, 1e-12);
  EXPECT_NEAR(wrap_angle(pose.yaw_rad()), 0.0, 1e-12);
}

RC_GTEST_PROP(Kinematics, InverseUndoesForward, ()) {
  const auto number = [](int most) { return *rc::gen::inRange(-most, most) / 1000.0; };
  const WheelGeometry wheels{0.1 + number(20), 0.1 + number(20), 0.3 + number(100)};
  const VelocityCommand sent{number(2000), number(3000)};
  const VelocityCommand got = vehicle_velocity(wheels, wheel_speeds(wheels, sent));
  RC_ASSERT(std::abs(got.linear_mps - sent.linear_mps) < 1e-12);
  RC_ASSERT(std::abs(got.angular_radps - sent.angular_radps) < 1e-12);
}

struct Turn {
  double left_rad, right_rad;
};

std::vector<Turn> any_drive(int frames) {
  std::vector<Turn> drive;
  drive.reserve(static_cast<std::size_t>(frames));
  for (int i = 0; i < frames; ++i)
    drive.push_back({*rc::gen::inRange(-250, 250) / 1000.0, *rc::gen::inRange(-250, 250) / 1000.0});
  return drive;
}

double apart_m(const DiffDriveOdometry& a, const DiffDriveOdometry& b) {
  return distance_m(a.reading().odom_from_base.translation(), b.reading().odom_from_base.translation());
}

/// A frame can move the vehicle by its fastest wheel's way; `kNoise` is the resolution of two 14-bit
/// readings.
constexpr double kFrameWorthM = 0.1 * 0.25;
constexpr double kNoiseM = 1e-4;

RC_GTEST_PROP(DiffDriveOdometry, DroppedFramesCostAtMostOneFramesWorthEach, ()) {
  Wheels wheels;
  DiffDriveOdometry all({}), some({});
  int missing = 0;
  for (const auto [left, right] : any_drive(60)) {
    const wire::Status status = wheels.turn(left, right);
    const double before_m = apart_m(all, some);
    const auto pose = some.reading().odom_from_base;
    all.update(status, {});
    const bool drop = *rc::gen::inRange(0, 4) == 0;
    if (!drop) some.update(status, {});
    missing = drop ? missing + 1 : 0;
    RC_ASSERT(apart_m(all, some) <= before_m + kFrameWorthM + kNoiseM);
    const double moved_m = distance_m(pose.translation(), some.reading().odom_from_base.translation());
    RC_ASSERT(moved_m <= (drop ? 0.0 : 60 * kFrameWorthM));
  }
}

RC_GTEST_PROP(DiffDriveOdometry, OneDroppedFrameIsMadeUpByTheNext, ()) {
  Wheels wheels;
  DiffDriveOdometry all({}), some({});
  const auto drive = any_drive(20);
  const auto dropped = *rc::gen::inRange<std::size_t>(1, 19);
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const wire::Status status = wheels.turn(drive[i].left_rad, drive[i].right_rad);
    all.update(status, {});
    if (i != dropped) some.update(status, {});
    RC_ASSERT(apart_m(all, some) <= kFrameWorthM + kNoiseM);
  }
  RC_ASSERT(some.counters().dropped == 1U);
  const double yaw = all.reading().odom_from_base.yaw_rad() - some.reading().odom_from_base.yaw_rad();
  RC_ASSERT(std::abs(wrap_angle(yaw)) < 1e-9);
}

RC_GTEST_PROP(DiffDriveOdometry, RepeatedAndLateFramesMoveNothing, ()) {
  Wheels wheels;
  DiffDriveOdometry odometry({}), peer({});
  std::vector<wire::Status> sent;
  for (const auto [left, right] : any_drive(40)) {
    sent.push_back(wheels.turn(left, right));
    odometry.update(sent.back(), {});
    peer.update(sent.back(), {});
    const auto echoes = *rc::gen::inRange(0, 3);
    for (int i = 0; i < echoes; ++i) {
      const auto back = *rc::gen::inRange<std::size_t>(1, std::min<std::size_t>(sent.size(), 5) + 1);
      RC_ASSERT(odometry.update(sent[sent.size() - back], {}) == OdometryVerdict::Duplicate);
    }
    RC_ASSERT(apart_m(odometry, peer) == 0.0);
  }
}

TEST(DiffDriveOdometry, RefusesOneImpossibleReadingAndLosesNothing) {
  Wheels wheels;
  DiffDriveOdometry odometry({}), peer({});
  for (int i = 0; i < 10; ++i) {
    wire::Status status = wheels.turn(0.1, 0.1);
    peer.update(status, {});
    if (i == 5) {
      status.left_angle = static_cast<std::uint16_t>(status.left_angle ^ 0x2000U);
      EXPECT_EQ(odometry.update(status, {}), OdometryVerdict::Jump);
    } else {
      odometry.update(status, {});
    }
  }
  EXPECT_NEAR(apart_m(odometry, peer), 0.0, 1e-5);  // two frames as one arc
  EXPECT_EQ(odometry.counters().jumps, 1U);
  EXPECT_EQ(odometry.counters().dropped, 0U);
}

TEST(DiffDriveOdometry, ALastingJumpNeverMovesThePose) {
  Wheels wheels;
  DiffDriveOdometry odometry({});
  double before_m = 0.0;
  for (int i = 0; i < 300; ++i) {
    wire::Status status = wheels.turn(0.1, 0.1);
    if (i >= 100) status.left_turns = static_cast<std::int16_t>(status.left_turns + 3);
    odometry.update(status, {});
    const double x_m = odometry.reading().odom_from_base.x_m();
    EXPECT_LE(std::abs(x_m - before_m), kFrameWorthM);
    before_m = x_m;
  }
  EXPECT_EQ(odometry.counters().restarts, 1U);
  EXPECT_NEAR(before_m, 0.1 * 0.1 * 297, 1e-3);  // the first takes the reference, the jump costs two frames
}

TEST(DiffDriveOdometry, SurvivesARebootOfTheController) {
  DiffDriveOdometry odometry({});
  for (int run = 0; run < 2; ++run) {
    Wheels wheels;
    for (int i = 0; i < 100 - 50 * run; ++i) odometry.update(wheels.turn(0.1, 0.1), {});
  }
  EXPECT_EQ(odometry.counters().restarts, 1U);
  EXPECT_NEAR(odometry.reading().odom_from_base.x_m(), 0.1 * 0.1 * (99 + 50 - 16), 1e-3);
}

TEST(DiffDriveOdometry, RefusesNonsenseGeometry) {
  EXPECT_THROW(DiffDriveOdometry({.wheels = {0.1, 0.1, 0.0}}), Error);
  EXPECT_THROW(DiffDriveOdometry({.wheels = {0.1, std::nan(""), 0.2}}), Error);
}

/// UMBmark (Borenstein and Feng 1996): a square of 25 m sides is driven exactly, each side straight, each
/// corner on the spot, by a vehicle whose right wheel is larger than the odometry believes. Every side then
/// looks like an arc that turns by `bend`, every corner like a turn by `corner` with a creep; four equal
/// steps are a geometric series.
std::complex<double> closed_form_end(double side_m, double direction, double ratio,
                                     const WheelGeometry& believed) {
  using namespace std::complex_literals;
  const double d = believed.half_separation_m;
  const double seen_left = 1.0, seen_right = 1.0 / ratio;  // what a metre on the floor looks like
  const double bend = side_m * (seen_right - seen_left) / (2.0 * d);
  const double length = side_m * (seen_right + seen_left) / 2.0;
  const double arc_m =
      direction * kPi / 2.0 * d;  // way of the right wheel in a corner, the left goes backward
  const double corner = arc_m * (seen_right + seen_left) / (2.0 * d);
  const double creep = arc_m * (seen_right - seen_left) / 2.0;
  const auto chord = [](double way, double turn) { return way * (std::exp(1i * turn) - 1.0) / (1i * turn); };
  const std::complex<double> step = chord(length, bend) + std::exp(1i * bend) * chord(creep, corner);
  const double turn = bend + corner;
  return step * (std::exp(4.0i * turn) - 1.0) / (std::exp(1i * turn) - 1.0);
}

TEST(DiffDriveOdometry, MatchesTheClosedFormOfUmbmark) {
  const WheelGeometry believed{0.1, 0.1, 0.25};
  for (const double ratio : {1.001, 0.995, 1.01})
    for (const double direction : {1.0, -1.0}) {
      Wheels wheels;
      DiffDriveOdometry odometry({.wheels = believed});
      odometry.update(wheels.turn(0.0, 0.0), {});
      const auto drive = [&](double left_m, double right_m) {
        constexpr int kSteps = 2000;
        for (int i = 0; i < kSteps; ++i)
          odometry.update(wheels.turn(left_m / 0.1 / kSteps, right_m / (0.1 * ratio) / kSteps), {});
      };
      for (int side = 0; side < 4; ++side) {
        drive(25.0, 25.0);
        drive(-direction * kPi / 2.0 * 0.25, direction * kPi / 2.0 * 0.25);
      }
      const auto expected = closed_form_end(25.0, direction, ratio, believed);
      EXPECT_NEAR(odometry.reading().odom_from_base.x_m(), expected.real(), 0.01)
          << ratio << ' ' << direction;
      EXPECT_NEAR(odometry.reading().odom_from_base.y_m(), expected.imag(), 0.01)
          << ratio << ' ' << direction;
      EXPECT_GT(std::abs(expected), 0.3) << "the error must be visible";
    }
}

}  // namespace
}  // namespace madori::control
