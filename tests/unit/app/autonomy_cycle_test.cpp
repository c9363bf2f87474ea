#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/demo/played_operator.hpp"
#include "planning/route_graph/route_csv.hpp"
#include "tests/support/toy_vehicle.hpp"

namespace madori::app {
namespace {

using test::ToyVehicle;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// A long corridor 0 - 1 - 2, and a loop 1 - 3 - 2 beside it.
planning::RouteGraph routes() {
  return planning::parse_routes("ID,EDA\n0,1\n1,0 2 3\n2,1 3\n3,1 2\n",
                                "ID,x,y,heading_deg\n0,0,0,\n1,10,0,\n2,22,0,90\n3,16,6,\n")
      .graph;
}

std::unique_ptr<ToyVehicle> vehicle() {
  return std::make_unique<ToyVehicle>(test::toy_config(routes()), Transform2<Map, Base>(0.0, 0.0, 0.0));
}

TEST(AutonomyCycle, NothingMovesUntilTheOperatorLetsIt) {
  auto v = vehicle();
  v->drive_to({{2}});
  EXPECT_FALSE(v->run_until([&] { return v->rolling.speed().linear_mps != 0.0; }, 5.0));
  EXPECT_EQ(v->state().mode, Mode::Paused);
  EXPECT_EQ(v->state().standstill.remedy.text, "press Resume");
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.5; }, 5.0));
}

TEST(AutonomyCycle, AnOrderIsDeliveredAndTheGoalIsMetInPlaceAndHeading) {
  auto v = vehicle();
  v->drive_to({{1, StopAction::Load, 1.0}, {2, StopAction::Unload, 0.0}});
  v->say(OperatorWord::Resume);
  bool loading = false;
  v->each_step = [&] { loading = loading || v->state().standstill.cause.text == "loading"; };
  ASSERT_TRUE(v->run_until([&] { return v->delivered(); }, 90.0));
  EXPECT_TRUE(loading);
  EXPECT_LT(distance_m(v->rolling.pose().translation(), Point2<Map>{22.0, 0.0}), 0.02);
  EXPECT_LT(std::abs(wrap_angle(v->rolling.pose().yaw_rad() - kPi / 2.0)), to_rad(1.0));
  v->run_until([&] { return false; }, 1.0);
  EXPECT_EQ(v->state().mode, Mode::Idle);
}

TEST(AutonomyCycle, TheEmergencyStopHoldsUntilConfirmedAndResumed) {
  auto v = vehicle();
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
    auto v = vehicle();
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
    auto v = vehicle();
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
  auto v = vehicle();
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

TEST(AutonomyCycle, LostMeansStandingAndLocalizedMeansGoingOn) {
  auto v = vehicle();
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

TEST(AutonomyCycle, APersonInTheWayIsWaitedFor) {
  auto v = vehicle();
  v->config.detour_after_s = 1000.0;
  v->lidar.posts.push_back({{6.0, 0.0}, 0.2, 1.7});
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  double nearest = 10.0;
  v->each_step = [&] { nearest = std::min(nearest, v->clearance_m()); };
  v->run_until([&] { return false; }, 12.0);
  EXPECT_EQ(v->state().mode, Mode::Waiting);
  EXPECT_EQ(v->state().standstill.cause.text, "something stands in the way");
  EXPECT_GT(nearest, 0.1);
  EXPECT_LT(nearest, 0.8);
  v->lidar.posts.clear();
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
}

TEST(AutonomyCycle, WhatCameTooNearForTheLidarStaysUntilTheOperatorHasLooked) {
  auto v = vehicle();
  v->config.detour_after_s = 1000.0;
  v->lidar.bodies.push_back(
      {{{6.0, -0.3}, {6.0, 0.3}}, 0.1, 0.2});  // lies lower than the lidar's lowest beam
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->state().mode == Mode::Waiting; }, 15.0));
  v->run_until([&] { return false; }, 2.0);
  EXPECT_EQ(v->state().standstill.cause.code, "unseen-in-the-way");
  EXPECT_EQ(v->state().standstill.remedy.code, "look-and-resume");
  v->lidar.bodies.clear();
  EXPECT_FALSE(v->run_until([&] { return v->state().mode == Mode::Driving; }, 10.0)) << "nobody has looked";
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
}

TEST(AutonomyCycle, AVehicleThatDrivesAndDoesNotGetOnStopsAndSaysSo) {
  using Held = test::RollingVehicle::Held;
  for (const Held how : {Held::Slipping, Held::Blocked}) {
    auto v = vehicle();
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
    v->rolling.held = how;
    ASSERT_TRUE(v->run_until([&] { return v->state().mode == Mode::Waiting; }, 4.0));
    EXPECT_EQ(v->state().standstill.cause, notice(Cause::HeldBack));
    EXPECT_EQ(v->state().standstill.remedy, notice(Remedy::LookAndResume));
    v->run_until([&] { return false; }, 1.0);
    EXPECT_FALSE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.05; }, 8.0)) << "it pushes on";
    v->rolling.held = Held::No;
    v->say(OperatorWord::Resume);
    EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
  }
}

/// To slipping wheels somebody who stands there seems to move: the vehicle stops and starts, and still
/// notices.
TEST(AutonomyCycle, ShortStopsDoNotHideThatItDoesNotGetOn) {
  auto v = vehicle();
  v->config.detour_after_s = 1000.0;
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.pose().x_m() > 5.0; }, 15.0));
  v->rolling.held = test::RollingVehicle::Held::Slipping;
  v->lidar.posts.push_back({{4.4, 0.0}, 0.1, 1.7});
  EXPECT_TRUE(v->run_until([&] { return v->state().standstill.cause == notice(Cause::HeldBack); }, 20.0));
}

/// Something too low to be seen, 0.4 m wide, that stops the bumper: the vehicle can only go back, and around.
TEST(AutonomyCycle, AHeldVehicleGoesBackTheWayItCameAndAround) {
  using Held = test::RollingVehicle::Held;
  auto v = vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  double furthest_back_m = 0.0;
  double most_m = 0.0;
  v->each_step = [&] {
    const auto& pose = v->rolling.pose();
    bool touches = false;
    for (double y = -0.2; y < 0.21; y += 0.1)
      touches = touches ||
                v->config.check.vehicle.grown(0.005, 0.005).contains(pose.inverse() * Point2<Map>{6.0, y});
    v->rolling.held = touches ? Held::Ahead : Held::No;
    most_m = std::max(most_m, pose.x_m());
    if (most_m < 5.3) furthest_back_m = std::max(furthest_back_m, most_m - pose.x_m());
  };
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 150.0)) << v->state().standstill.cause.text;
  EXPECT_GT(furthest_back_m, 0.4);
  EXPECT_LT(furthest_back_m, 1.2);
}

TEST(AutonomyCycle, AVehicleDoesNotGoBackWhereSomethingHasComeBehindIt) {
  auto v = vehicle();
  v->config.detour_after_s = 1000.0;
  v->config.reroute_after_s = 1000.0;
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.pose().x_m() > 5.0; }, 15.0));
  v->rolling.held = test::RollingVehicle::Held::Ahead;
  v->lidar.posts.push_back({{4.4, 0.0}, 0.1, 1.7});  // somebody stands 0.3 m behind it
  double nearest = 10.0;
  v->each_step = [&] { nearest = std::min(nearest, v->clearance_m()); };
  EXPECT_FALSE(v->run_until([&] { return v->state().way.backing && nearest < 0.1; }, 40.0));
  EXPECT_EQ(v->state().standstill.cause, notice(Cause::HeldBack));
  EXPECT_GT(nearest, 0.1);
}

TEST(AutonomyCycle, ADriveWhoseLinkOpensLateIsArmed) {
  auto v = vehicle();
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
  auto v = vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
  v->restart_drive();
  EXPECT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps < 0.1; }, 2.0));
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << v->state().standstill.cause.text;
}

TEST(AutonomyCycle, ThePlayedOperatorConfirmsAFaultAndTheOrderIsDelivered) {
  auto v = vehicle();
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
  auto v = vehicle();
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

TEST(AutonomyCycle, APalletIsDrivenAround) {
  auto v = vehicle();
  v->lidar.bodies.push_back({{{6.0, -0.4}, {6.0, 0.4}}, 0.4, 0.3});
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  double nearest = 10.0;
  v->each_step = [&] { nearest = std::min(nearest, v->clearance_m()); };
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 90.0)) << v->state().standstill.cause.text;
  EXPECT_GT(nearest, 0.03);
  EXPECT_THAT(v->events, Contains(HasSubstr("-> detouring")));
  EXPECT_THAT(v->events, Contains(HasSubstr("back on route")));
}

TEST(AutonomyCycle, StandingAHairWithinItsOwnMarginBesideABodyItGetsOutAfterAWhile) {
  for (const bool squeezes : {true, false}) {
    auto v = vehicle();
    if (!squeezes) v->config.squeeze_after_s = 1e6;
    v->lidar.posts.push_back({{0.2, 0.44}, 0.1, 1.0});  // 4 cm beside the vehicle, which keeps 6 cm
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    double nearest = 10.0;
    v->each_step = [&] { nearest = std::min(nearest, v->clearance_m()); };
    EXPECT_FALSE(v->run_until([&] { return v->rolling.pose().x_m() > 0.1; }, 9.0));
    EXPECT_EQ(v->run_until([&] { return v->delivered(); }, 60.0), squeezes)
        << ::testing::PrintToString(v->events);
    EXPECT_GT(nearest, 0.0);
  }
}

TEST(AutonomyCycle, ABlockedLegIsLeftOutOfANewRoute) {
  auto v = vehicle();
  v->config.detour_after_s = 1000.0;
  v->config.reroute_after_s = 3.0;
  for (double y = -2.0; y < 2.0; y += 0.2) v->lidar.posts.push_back({{14.0, y}, 0.15, 1.0});
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 120.0)) << ::testing::PrintToString(v->events);
  EXPECT_THAT(v->events, Contains(HasSubstr("taking another route")));
}

TEST(AutonomyCycle, AWayAroundThatEndsAtTheGoalEndsInItsHeading) {
  for (const double heading_deg : {0.0, 90.0}) {
    auto graph = planning::parse_routes("ID,EDA\n0,1\n1,0\n",
                                        "ID,x,y,heading_deg\n0,0,0,\n1,8,0," + std::to_string(heading_deg))
                     .graph;
    ToyVehicle v(test::toy_config(std::move(graph)), {0.0, 0.0, 0.0});
    for (double y = -0.8; y < 3.0; y += 0.2) v.lidar.posts.push_back({{5.4, y}, 0.1, 1.5});
    v.drive_to({{1}});
    v.say(OperatorWord::Resume);
    ASSERT_TRUE(v.run_until([&] { return v.delivered(); }, 90.0)) << ::testing::PrintToString(v.events);
    EXPECT_THAT(v.events, Contains(HasSubstr("detour found")));
    EXPECT_LT(std::abs(wrap_angle(v.rolling.pose().yaw_rad() - to_rad(heading_deg))), to_rad(1.0))
        << heading_deg;
  }
}

TEST(AutonomyCycle, WhatLiesBeforeADoorIsNoDoor) {
  auto routes = planning::parse_routes("ID,EDA\n0,1\n1,0 2\n2,1\n",
                                       "ID,x,y,heading_deg,action\n0,0,0,,\n1,7,0,,door\n2,14,0,,\n");
  test::ToyVehicle v(test::toy_config(std::move(routes.graph)), {0.0, 0.0, 0.0});
  v.lidar.bodies.push_back({{{6.0, -0.3}, {6.0, 0.3}}, 0.1, 0.2});  // too low to be seen from near
  v.drive_to({{2}});
  v.say(OperatorWord::Resume);
  EXPECT_TRUE(v.run_until([&] { return v.delivered(); }, 60.0)) << v.state().standstill.cause.text;
  EXPECT_THAT(v.events, Contains(HasSubstr("detour found"))) << "a door is waited for, this is driven around";
}

TEST(AutonomyCycle, ADoorThatStaysShutIsLeftOutOfANewRouteAfterAWhile) {
  auto graph =
      planning::parse_routes("ID,EDA\n0,1\n1,0 4 3\n4,1 2\n2,4 3\n3,1 2\n",
                             "ID,x,y,heading_deg,action\n0,0,0,,\n1,10,0,,\n4,15,0,,door\n2,22,0,90,\n"
                             "3,16,6,,\n")
          .graph;
  ToyVehicle v(test::toy_config(graph), Transform2<Map, Base>(0.0, 0.0, 0.0));
  for (double y = -2.0; y < 2.0; y += 0.2) v.lidar.posts.push_back({{15.0, y}, 0.15, 2.2});
  v.drive_to({{2}});
  v.say(OperatorWord::Resume);
  ASSERT_TRUE(v.run_until([&] { return v.state().standstill.cause == notice(Cause::DoorNotOpen); }, 40.0));
  v.run_until([&] { return false; }, 50.0);
  EXPECT_THAT(v.events, Not(Contains(HasSubstr("taking another route")))) << "it may open";
  EXPECT_TRUE(v.run_until([&] { return v.delivered(); }, 90.0)) << ::testing::PrintToString(v.events);
  EXPECT_THAT(v.events, Contains(HasSubstr("taking another route")));
}

// The edge of something remembered, or somebody who works beside the way.
TEST(AutonomyCycle, WhatStirsInOnePlaceBesideTheWayDoesNotHoldTheVehicleForEver) {
  for (const bool for_ever : {false, true}) {
    auto v = vehicle();
    if (for_ever) v->config.mover_stays_after_s = 1e6;
    v->lidar.posts.push_back({{6.0, 0.9}, 0.1, 1.0});
    v->each_step = [&] { v->lidar.posts[0].at.y_m = 0.9 + 0.2 * std::sin(2.0 * kPi * v->time_s()); };
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    EXPECT_TRUE(v->run_until([&] { return v->state().way.by_mover; }, 15.0));
    EXPECT_NE(v->run_until([&] { return v->delivered(); }, 60.0), for_ever)
        << ::testing::PrintToString(v->events);
  }
}

TEST(AutonomyCycle, AnUnknownNodeIsRefusedAndSaidSo) {
  auto v = vehicle();
  v->drive_to({{99}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->output.order_refused.has_value(); }, 2.0));
  EXPECT_EQ(v->output.order_refused->second, "node 99 is not in the routes");
}

TEST(AutonomyCycle, ManualModeFollowsTheHeldKeyAndStopsWithoutIt) {
  auto v = vehicle();
  v->say(OperatorWord::ManualOn);
  v->commands.push_back({OperatorWord::Jog, {0.3, 0.0}});
  v->run_until([&] { return false; }, 0.2);
  EXPECT_GT(v->output.command.linear_mps, 0.0);
  v->run_until([&] { return false; }, 0.2);
  EXPECT_EQ(v->output.command, VelocityCommand{}) << "the key is silent for longer than 0.3 s";
  v->say(OperatorWord::ManualOff);
  v->step();
  EXPECT_EQ(v->state().mode, Mode::Paused);
}

TEST(AutonomyCycle, APlaceThatAPersonGivesReachesLocalization) {
  auto v = vehicle();
  v->commands.push_back({OperatorWord::SetPose, {}, {{std::nan(""), 0.0}, 0.0, {}}});
  v->commands.push_back({OperatorWord::SetPose, {}, {{1.0, 0.0}, 0.0, {0.0, 0.1}}});
  v->step();
  EXPECT_FALSE(v->pose->given) << "neither is a pose with an uncertainty";
  v->commands.push_back({OperatorWord::SetPose, {}, {{1.5, -2.0}, 0.5, {}}});
  v->step();
  ASSERT_TRUE(v->pose->given);
  EXPECT_EQ(v->pose->given->translation(), (Point2<Map>{1.5, -2.0}));
  EXPECT_EQ(v->pose->given->yaw_rad(), 0.5);
}

TEST(AutonomyCycle, RecordedInputsGiveTheSameCommandsBitForBit) {
  auto v = vehicle();
  v->record = true;
  v->lidar.bodies.push_back({{{6.0, -0.4}, {6.0, 0.4}}, 0.4, 0.3});
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  std::vector<Transform2<Map, Base>> poses;
  v->each_step = [&] { poses.push_back(v->rolling.pose()); };
  ASSERT_TRUE(v->run_until([&] { return v->delivered(); }, 90.0));

  class Recorded : public PoseSource {
   public:
    PoseEstimate on_odometry(const OdometryReading& reading) override { return at(reading.stamp); }
    void on_cloud(const PointCloud<Base>& /*cloud*/, const Transform2<Odom, Base>& /*odom*/) override {}
    void set_pose(const Transform2<Map, Base>& /*pose*/, const PoseSigma& /*sigma*/) override {}
    void search_anew() override {}
    [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return {}; }
    Transform2<Map, Base> pose;

   private:
    [[nodiscard]] PoseEstimate at(Stamp stamp) const {
      return {stamp, pose, Eigen::Matrix3d::Identity() * 1e-6, {LocalizationState::Localized, ""}};
    }
  };
  auto source = std::make_unique<Recorded>();
  Recorded& recorded = *source;
  CycleState state(v->config, std::move(source));
  for (std::size_t i = 0; i < v->inputs.size(); ++i) {
    recorded.pose = poses[i];
    auto [after, output] = step(std::move(state), v->inputs[i], v->config);
    state = std::move(after);
    ASSERT_EQ(output.command, v->driven[i]) << "step " << i;
  }
}

}  // namespace
}  // namespace madori::app
