#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/cycle/stages.hpp"
#include "app/demo/played_operator.hpp"
#include "tests/unit/app/corridor_vehicle.hpp"

// What stops the vehicle at once, and who may let it go on.
namespace madori::app {
namespace {

using test::corridor_vehicle;
using ::testing::Contains;
using ::testing::HasSubstr;

/// On its way to node 2, nearly as fast as it may.
auto vehicle_at_speed() {
  auto v = corridor_vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
  return v;
}

TEST(AutonomyCycle, TheEmergencyStopHoldsUntilConfirmedAndResumed) {
  auto v = vehicle_at_speed();
  v->emergency_stop = true;
  v->step();
  EXPECT_EQ(v->state().mode, Mode::EmergencyStop);
  EXPECT_EQ(v->output.command, VelocityCommand{});
  EXPECT_FALSE(v->output.enable);
  v->say(OperatorWord::Confirm);
  v->run_until([&] { return false; }, 1.0);
  EXPECT_EQ(v->state().mode, Mode::EmergencyStop) << "it is still pressed";
  v->emergency_stop = false;
  EXPECT_FALSE(v->run_until([&] { return v->output.enable; }, 3.0)) << "nobody confirmed";
  v->say(OperatorWord::Confirm);
  EXPECT_FALSE(v->run_until([&] { return v->output.enable; }, 3.0)) << "nobody let it go on";
  EXPECT_EQ(v->state().mode, Mode::Paused);
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
}

TEST(AutonomyCycle, BumperAndSilentDriveAndPauseStopAtOnce) {
  for (const int what : {0, 1, 2}) {
    auto v = vehicle_at_speed();
    if (what == 0) v->bumper = true;
    if (what == 1) v->drive_silent = true;
    if (what == 2) v->say(OperatorWord::Pause);
    v->run_until([&] { return false; }, 0.5);
    EXPECT_EQ(v->state().mode, what == 0 ? Mode::EmergencyStop : what == 1 ? Mode::Waiting : Mode::Paused);
    EXPECT_EQ(v->output.command, VelocityCommand{});
    EXPECT_FALSE(v->output.enable);
  }
}

TEST(AutonomyCycle, ADriveThatWasDeafGoesOnByItselfButOneThatWasSwitchedOffDoesNot) {
  for (const bool switched_off : {false, true}) {
    auto v = vehicle_at_speed();
    v->drive_silent = true;
    v->run_until([&] { return false; }, 2.0);
    EXPECT_EQ(v->state().mode, Mode::Waiting);
    EXPECT_EQ(v->state().standstill.cause, notice(Cause::DriveSilent));
    if (switched_off) v->drive_started_s = v->time_s() - 1.0;
    v->drive_silent = false;
    EXPECT_EQ(v->run_until([&] { return v->delivered(); }, 60.0), !switched_off);
    if (switched_off) {
      EXPECT_EQ(v->state().mode, Mode::EmergencyStop);
    }
  }
}

/// The controller's clock, which a power cut sets to zero, may just have been about to wrap.
TEST(AutonomyCycle, APowerCutBeforeTheDrivesClockWrapsIsNoticed) {
  constexpr double kWrapS = 4294.967296;
  for (const auto& [left_s, off_s] :
       {std::pair(20.0, 60.0), std::pair(300.0, 600.0), std::pair(20.0, 10.0)}) {
    auto v = corridor_vehicle();
    v->drive_started_s = -(kWrapS - 10.0 - left_s);
    for (double before_s = 0.0; before_s < kWrapS - 10.0 - left_s; before_s += 0.02) v->count_frames();
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    v->run_until([&] { return v->time_s() > 10.0; }, 20.0);
    v->drive_silent = true;
    v->run_until([&] { return false; }, off_s);
    v->restart_drive();
    v->drive_started_s = v->time_s() - 0.5;
    v->drive_silent = false;
    EXPECT_FALSE(v->run_until([&] { return v->delivered(); }, 10.0)) << off_s << " s off";
    EXPECT_EQ(v->state().mode, Mode::EmergencyStop);
  }
}

/// A late step, or a silent link: a stop that began and ended meanwhile is a stop.
TEST(AutonomyCycle, AStopBetweenTwoLooksIsHeld) {
  for (const bool silent : {false, true})
    for (const bool by_bumper : {false, true})
      for (const double away_s : {0.24, 0.6, 1.5}) {
        auto v = vehicle_at_speed();
        (silent ? v->drive_silent : v->hung) = true;
        for (double t = 0.0; t < away_s; t += 0.02) {
          (by_bumper ? v->bumper : v->emergency_stop) = t < 0.02;
          v->step();
        }
        v->drive_silent = v->hung = false;
        EXPECT_FALSE(v->run_until([&] { return v->delivered(); }, 10.0)) << silent << by_bumper << away_s;
        EXPECT_EQ(v->state().mode, Mode::EmergencyStop);
      }
}

/// What the wheels do not do is no speed that they could go on with.
TEST(AutonomyCycle, ADriveThatHearsNothingIsNamedAndStartsAnewFromStandstill) {
  auto v = vehicle_at_speed();
  v->drive_deaf = true;
  v->run_until([&] { return false; }, 10.0);
  EXPECT_EQ(v->state().mode, Mode::Waiting);
  EXPECT_EQ(v->state().standstill.cause, notice(Cause::DriveDeaf));
  v->drive_deaf = false;
  double before_mps = 0.0;
  v->on_step = [&](const auto& /*input*/, const auto& output, const auto& /*state*/) {
    EXPECT_LT(output.command.linear_mps - before_mps, v->config.limits.acceleration_mps2 * 0.021);
    before_mps = std::max(
        0.0, v->drive_state() == control::wire::DriveState::Running ? output.command.linear_mps : 0.0);
  };
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
}

/// An adapter that keeps more and more bytes to itself: the wheels do what they were told long ago, and no
/// wheel is to blame.
TEST(AutonomyCycle, CommandsThatComeLateAreNamedAndTheVehicleStandsUntilTheyComeInTime) {
  for (const int steps_for_one_more : {1, 5, 10}) {
    auto v = vehicle_at_speed();
    int steps = 0;
    v->each_step = [&] { v->commands_wait = std::min(15, ++steps / steps_for_one_more); };
    EXPECT_TRUE(v->run_until([&] { return v->output.command == VelocityCommand{}; }, 4.0));
    EXPECT_LT(v->commands_wait, 15U);
    v->run_until([&] { return false; }, 5.0);
    EXPECT_EQ(v->state().mode, Mode::Waiting) << steps_for_one_more;
    EXPECT_EQ(v->state().standstill.cause, notice(Cause::DriveLate)) << v->state().standstill.cause.code;
    v->each_step = {};
    v->commands_wait = 0;
    EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << steps_for_one_more;
  }
}

/// Statuses come, but the angle of a wheel is noise.
TEST(AutonomyCycle, AStatusThatTellsNothingOfTheWheelsIsNoSignOfLife) {
  auto v = vehicle_at_speed();
  int told = 0;
  v->each_status = [&](control::wire::Status& status) {
    status.left_turns = static_cast<std::int16_t>(status.left_turns + 1000 * ++told);
  };
  EXPECT_TRUE(v->run_until([&] { return v->output.command == VelocityCommand{}; }, 0.5));
  v->run_until([&] { return false; }, 0.25);
  EXPECT_EQ(v->state().standstill.cause, notice(Cause::WheelsUntold));
  v->each_status = {};
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
}

/// Its cable is not plugged in, or the device named is not there.
TEST(AutonomyCycle, ADriveThatNeverSpokeIsNotSaidToAnswer) {
  auto v = corridor_vehicle();
  v->drive_silent = true;
  v->each_step = [&] { EXPECT_NE(v->state().standstill.cause, notice(Cause::WheelsUntold)); };
  v->run_until([&] { return false; }, 1.0);
  EXPECT_EQ(v->state().standstill.cause, notice(Cause::DriveSilent));
}

/// Its motors are switched off at a switch of their own.
TEST(AutonomyCycle, ADriveThatStaysIdleIsNamedAndGoesOn) {
  auto v = vehicle_at_speed();
  v->drive_deaf = true;
  v->each_status = [&](control::wire::Status& status) {
    status.command_sequence = v->newest_command();
    status.state = control::wire::DriveState::Idle;
    status.watchdog_expired = false;
  };
  v->run_until([&] { return false; }, 1.5);
  EXPECT_EQ(v->state().standstill.cause, notice(Cause::DriveIdle));
  EXPECT_THAT(v->events, Contains(HasSubstr("does not start although it is told to - check its power")));
  v->drive_deaf = false;
  v->each_status = {};
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
}

TEST(AutonomyCycle, SweepsOfAnotherTimeTellNothingOfNow) {
  auto v = vehicle_at_speed();
  v->cloud_age_s = 1.0;
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps < 0.01; }, 2.0));
  EXPECT_EQ(v->state().standstill.cause, notice(Cause::LidarSilent));
  v->cloud_age_s = 0.0;
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
}

TEST(AutonomyCycle, ByHandWithoutALidarItCreeps) {
  auto v = corridor_vehicle();
  v->run_until([&] { return false; }, 1.0);
  v->lidar_silent = true;
  v->run_until([&] { return false; }, 1.0);
  v->say(OperatorWord::ManualOn);
  for (const VelocityCommand& jog : {VelocityCommand{0.3, 0.0}, VelocityCommand{0.0, 0.5}}) {
    v->run_until([&] { return v->commands.push_back({OperatorWord::Jog, jog}), false; }, 2.0);
    EXPECT_NEAR(outline_mps(v->config.check.vehicle, v->output.command), v->config.out_of_field_mps, 0.01);
  }
}

TEST(AutonomyCycle, ASilentLidarStopsTheVehicleAndItGoesOnByItself) {
  auto v = vehicle_at_speed();
  v->lidar_silent = true;
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps < 0.01; }, 1.5));
  EXPECT_EQ(v->state().mode, Mode::Waiting);
  EXPECT_EQ(v->state().standstill.cause.text, "the lidar is silent");
  v->lidar_silent = false;
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
}

/// The program was stopped, or the computer's clock jumped, and the lidar's stamps need a while to follow.
TEST(AutonomyCycle, ATimeWithoutStepsStopsTheVehicleUntilSomethingIsMeasuredAnew) {
  for (const double jump_s : {2.5, 10.0, 3600.0}) {
    auto v = vehicle_at_speed();
    v->clock_s += jump_s;
    v->cloud_age_s = jump_s;
    v->step();
    EXPECT_EQ(v->output.command, VelocityCommand{});
    EXPECT_FALSE(v->output.enable);
    EXPECT_THAT(v->output.events, Contains(HasSubstr("the computer's clock jumped forward")));
    EXPECT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps < 0.01; }, 0.5));
    v->run_until([&] { return false; }, 2.0);
    EXPECT_EQ(v->state().mode, Mode::Waiting);
    EXPECT_EQ(v->state().standstill.cause, notice(Cause::TimeGap));
    EXPECT_NEAR(v->rolling.speed().linear_mps, 0.0, 1e-6);
    v->cloud_age_s = 0.0;
    EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << v->state().standstill.cause.text;
  }
}

TEST(AutonomyCycle, AfterATimeWithoutStepsADeviceThatStaysSilentIsCalledSilent) {
  auto v = vehicle_at_speed();
  v->clock_s += 10.0;
  v->lidar_silent = true;
  v->run_until([&] { return false; }, 1.0);
  EXPECT_EQ(v->state().standstill.cause, notice(Cause::LidarSilent));
}

TEST(AutonomyCycle, LostMeansStandingAndLocalizedMeansGoingOn) {
  auto v = vehicle_at_speed();
  v->pose->state = LocalizationState::Lost;
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps < 0.01; }, 1.5));
  EXPECT_EQ(v->state().mode, Mode::Localizing);
  EXPECT_THAT(v->state().standstill.cause.text, HasSubstr("told so by the test"));
  v->pose->state = LocalizationState::Localized;
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
}

/// Nobody carries a vehicle that drives: its lidar was knocked, or it is wrong. It turned with a lidar that
/// was twisted by 90 degrees, and drove four metres off its route.
TEST(AutonomyCycle, FoundElsewhereThanItsWheelsLedItAPersonLooksFirst) {
  struct Case {
    double x_m, yaw_rad;
    bool asks;
  };
  for (const Case& c : {Case{0.3, 0.1, false}, {0.0, 1.57, true}, {1.5, 0.0, true}}) {
    auto v = vehicle_at_speed();
    v->pose->state = LocalizationState::Lost;
    ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps < 0.01; }, 1.5));
    v->pose->beside = {c.x_m, 0.0, c.yaw_rad};
    v->pose->state = LocalizationState::Localized;
    v->run_until([&] { return false; }, 0.2);
    EXPECT_EQ(v->state().mode == Mode::Paused, c.asks) << c.x_m << " " << c.yaw_rad;
    v->pose->beside = {};
    if (c.asks) {
      v->run_until([&] { return false; }, 3.0);
      EXPECT_NEAR(v->rolling.speed().linear_mps, 0.0, 1e-6);
      EXPECT_EQ(v->state().standstill.cause.code, entry(Cause::FoundElsewhere).code);
      v->say(OperatorWord::Resume);
    }
    EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << v->state().standstill.cause.text;
  }
}

/// Who carried it, or told it its place, knows.
TEST(AutonomyCycle, WhoeverHadItInHandIsNotAskedWhereItStands) {
  for (const bool told : {false, true}) {
    auto v = vehicle_at_speed();
    if (!told) v->say(OperatorWord::Pause);
    v->pose->state = LocalizationState::Lost;
    ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps < 0.01; }, 1.5));
    v->pose->beside = {0.0, 0.0, 0.5};
    v->say(told ? OperatorWord::SetPose : OperatorWord::Resume);
    v->run_until([&] { return false; }, 0.2);
    v->pose->state = LocalizationState::Localized;
    v->run_until([&] { return false; }, 0.2);
    EXPECT_NE(v->state().mode, Mode::Paused) << told;
  }
}

TEST(AutonomyCycle, ADriveWhoseLinkOpensLateIsArmed) {
  auto v = corridor_vehicle();
  v->drive_silent = true;  // the port opens late: neither statuses nor commands pass
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  v->run_until([&] { return false; }, 3.0);
  EXPECT_EQ(v->rolling.speed(), VelocityCommand{});
  v->drive_silent = false;
  EXPECT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.5; }, 10.0))
      << v->state().standstill.cause.text;
}

TEST(AutonomyCycle, ADriveThatMissedCommandsWhileAllEnableIsArmedAgain) {
  auto v = vehicle_at_speed();
  v->drive_deaf = true;
  EXPECT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps < 0.1; }, 2.0));
  v->drive_deaf = false;
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << v->state().standstill.cause.text;
}

TEST(AutonomyCycle, ThePlayedOperatorConfirmsAFaultAndTheOrderIsDelivered) {
  auto v = corridor_vehicle();
  PlayedOperator person;
  v->each_step = [&] {
    v->drive_faults = v->time_s() > 5.0 && v->time_s() < 6.0 ? 1 : 0;
    for (const OperatorWord word : person.look(v->state().mode, stamp_from_seconds(v->time_s())))
      v->say(word);
  };
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << v->state().standstill.cause.text;
  EXPECT_EQ(person.confirmed(), 1);
  EXPECT_THAT(v->events, Contains("driving -> fault: fault on"));
  EXPECT_THAT(v->events, Contains("fault -> paused: confirmed"));
}

TEST(AutonomyCycle, ThePlayedOperatorLeavesAnEmergencyStopAlone) {
  auto v = corridor_vehicle();
  PlayedOperator person;
  v->each_step = [&] {
    v->emergency_stop = v->time_s() > 5.0 && v->time_s() < 6.0;
    for (const OperatorWord word : person.look(v->state().mode, stamp_from_seconds(v->time_s())))
      v->say(word);
  };
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  EXPECT_FALSE(v->run_until([&] { return v->delivered(); }, 40.0));
  EXPECT_EQ(v->state().mode, Mode::EmergencyStop);
  EXPECT_EQ(person.confirmed(), 0);
}

TEST(AutonomyCycle, AWheelThatDoesNotTurnIsNamedAndAPersonLetsItGoOn) {
  auto v = test::corridor_vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
  const double y_m = v->rolling.pose().y_m();
  v->right_wheel_share = 0.0;
  ASSERT_TRUE(v->run_until([&] { return v->state().mode == Mode::Fault; }, 0.3));
  EXPECT_EQ(v->state().standstill.cause.code, "right-wheel-disobeys");
  v->run_until([&] { return false; }, 2.0);
  EXPECT_NEAR(v->rolling.speed().linear_mps, 0.0, 1e-3);
  EXPECT_NEAR(v->rolling.pose().y_m(), y_m, 0.2);
  EXPECT_EQ(v->state().standstill.cause.code, "right-wheel-disobeys") << "it is still said once it stands";
  v->right_wheel_share = 1.0;
  v->say(OperatorWord::Confirm);
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
}

/// The true pose, or what is none.
class BrokenPose : public test::TruePose {
 public:
  using TruePose::TruePose;
  PoseEstimate on_odometry(const OdometryReading& reading) override {
    PoseEstimate pose = TruePose::on_odometry(reading);
    if (of_place) pose.map_from_base = {std::nan(""), 0.0, 0.0};
    if (of_covariance) pose.covariance(0, 0) = std::nan("");
    return pose;
  }
  bool of_place = false, of_covariance = false;
};

TEST(AutonomyCycle, WhatIsNoPoseIsNotDrivenBy) {
  for (const bool of_place : {true, false}) {
    auto v = corridor_vehicle();
    auto source = std::make_unique<BrokenPose>(v->rolling);
    BrokenPose& pose = *source;
    v->set_source(std::move(source));
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
    (of_place ? pose.of_place : pose.of_covariance) = true;
    v->step();
    EXPECT_EQ(v->output.command, VelocityCommand{});
    EXPECT_EQ(v->state().mode, Mode::Localizing);
    EXPECT_TRUE(v->state().pose.map_from_base.is_finite());
    pose.of_place = pose.of_covariance = false;
    EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << v->state().standstill.cause.text;
  }
}

}  // namespace
}  // namespace madori::app
