#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/demo/played_operator.hpp"
#include "tests/unit/app/corridor_vehicle.hpp"

// What stops the vehicle at once, and who may let it go on.
namespace madori::app {
namespace {

using test::corridor_vehicle;
using ::testing::Contains;
using ::testing::HasSubstr;

TEST(AutonomyCycle, TheEmergencyStopHoldsUntilConfirmedAndResumed) {
  auto v = corridor_vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
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
    auto v = corridor_vehicle();
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
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
    auto v = corridor_vehicle();
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
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

TEST(AutonomyCycle, ASilentLidarStopsTheVehicleAndItGoesOnByItself) {
  auto v = corridor_vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
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
    auto v = corridor_vehicle();
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
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
  auto v = corridor_vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
  v->clock_s += 10.0;
  v->lidar_silent = true;
  v->run_until([&] { return false; }, 1.0);
  EXPECT_EQ(v->state().standstill.cause, notice(Cause::LidarSilent));
}

TEST(AutonomyCycle, LostMeansStandingAndLocalizedMeansGoingOn) {
  auto v = corridor_vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
  v->pose->state = LocalizationState::Lost;
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps < 0.01; }, 1.5));
  EXPECT_EQ(v->state().mode, Mode::Localizing);
  EXPECT_THAT(v->state().standstill.cause.text, HasSubstr("told so by the test"));
  v->pose->state = LocalizationState::Localized;
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
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

TEST(AutonomyCycle, ADriveThatRestartsWhileAllCommandsEnableIsArmedAgain) {
  auto v = corridor_vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
  v->restart_drive();
  EXPECT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps < 0.1; }, 2.0));
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

}  // namespace
}  // namespace madori::app
