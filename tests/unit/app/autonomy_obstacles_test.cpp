#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/cycle/stages.hpp"
#include "tests/unit/app/corridor_vehicle.hpp"

// What stands in the way: waiting, driving around, another route.
namespace madori::app {
namespace {

using test::corridor_vehicle;
using test::ToyVehicle;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(AutonomyCycle, APersonInTheWayIsWaitedFor) {
  auto v = corridor_vehicle();
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
  auto v = corridor_vehicle();
  v->config.detour_after_s = v->config.back_out_after_s = 1000.0;
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

TEST(AutonomyCycle, APalletIsDrivenAround) {
  auto v = corridor_vehicle();
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
    auto v = corridor_vehicle();
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

TEST(AutonomyCycle, WhatIsSeenWhereTheVehicleStandsIsNoBody) {
  auto v = corridor_vehicle();
  v->config.squeeze_after_s = v->config.back_out_after_s = 1e6;
  v->lidar.posts.push_back({{0.1, 0.1}, 0.02, 0.89});  // lower than the highest part of the vehicle
  v->each_step = [&] { v->lidar.posts[0].at = (v->rolling.pose() * Point2<Base>{0.1, 0.1}); };
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << v->state().standstill.cause.text;
}

TEST(AutonomyCycle, ABlockedLegIsLeftOutOfANewRoute) {
  auto v = corridor_vehicle();
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
  ToyVehicle v(test::toy_config(std::move(routes.graph)), {0.0, 0.0, 0.0});
  v.lidar.bodies.push_back({{{6.0, -0.3}, {6.0, 0.3}}, 0.1, 0.2});  // too low to be seen from near
  v.drive_to({{2}});
  v.say(OperatorWord::Resume);
  EXPECT_TRUE(v.run_until([&] { return v.delivered(); }, 60.0)) << v.state().standstill.cause.text;
  EXPECT_THAT(v.events, Contains(HasSubstr("detour found"))) << "a door is waited for, this is driven around";
}

TEST(AutonomyCycle, WhatStandsBesideADoorThatIsNotOnItsWayIsNoDoor) {
  auto routes =
      planning::parse_routes("ID,EDA\n0,1\n1,0 2 3\n2,1\n3,1\n",
                             "ID,x,y,heading_deg,action\n0,0,0,,\n1,9,0,,\n2,20,0,,\n3,9,-2.5,,door\n");
  ToyVehicle v(test::toy_config(std::move(routes.graph)), {0.0, 0.0, 0.0});
  v.lidar.posts.push_back({{8.5, 0.0}, 0.3, 1.5});
  v.drive_to({{2}});
  v.say(OperatorWord::Resume);
  EXPECT_TRUE(v.run_until([&] { return v.delivered(); }, 60.0)) << v.state().standstill.cause.text;
  EXPECT_THAT(v.events, Contains(HasSubstr("detour found")));
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

// Turns included: the nose of a vehicle that turns on the spot is as fast as a vehicle that drives.
TEST(AutonomyCycle, WhereNobodySeesWhoLiesThereNoPointOfTheVehicleIsFast) {
  for (const bool guarded : {false, true}) {
    auto v = corridor_vehicle();
    v->config.sure_low_m = 0.0;
    if (guarded) v->config.low_bodies_guarded_by = "a bumper";
    double fastest_mps = 0.0;
    v->each_step = [&] {
      fastest_mps = std::max(fastest_mps, outline_mps(v->config.check.vehicle, v->output.command));
    };
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    ASSERT_TRUE(v->run_until([&] { return v->delivered(); }, 200.0));
    EXPECT_EQ(fastest_mps > 0.3 + 1e-9, guarded) << fastest_mps;
    EXPECT_GT(fastest_mps, 0.25);
    const auto said = Contains(HasSubstr("no lidar sees who lies on the floor ahead: at most 0.30 m/s"));
    if (guarded)
      EXPECT_THAT(v->events, Not(said));
    else
      EXPECT_THAT(v->events, said);
  }
}

TEST(AutonomyCycle, AVehicleIsDrivenByHandOutOfAProtectiveFieldSlowly) {
  auto v = corridor_vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.pose().x_m() > 2.0; }, 20.0));
  v->protective_stop = true;
  ASSERT_TRUE(v->run_until([&] { return v->state().mode == Mode::Waiting; }, 1.0));
  v->run_until([] { return false; }, 3.0);
  const double stood_m = v->rolling.pose().x_m();
  EXPECT_EQ(v->state().standstill.cause, notice(Cause::ProtectiveField));
  EXPECT_THAT(v->state().standstill.remedy.text, HasSubstr("by hand"));
  v->run_until([] { return false; }, 2.0);
  EXPECT_NEAR(v->rolling.pose().x_m(), stood_m, 1e-3) << "by itself it stands";
  v->say(OperatorWord::ManualOn);
  double fastest_mps = 0.0;
  v->each_step = [&] {
    v->commands.push_back({OperatorWord::Jog, {-0.5, 0.0}});
    fastest_mps = std::max(fastest_mps, std::abs(v->output.command.linear_mps));
  };
  v->run_until([] { return false; }, 3.0);
  EXPECT_LT(v->rolling.pose().x_m(), stood_m - 0.2);
  EXPECT_LE(fastest_mps, v->config.out_of_field_mps + 1e-9);
}

// The edge of something remembered, or somebody who works beside the way.
TEST(AutonomyCycle, WhatStirsInOnePlaceBesideTheWayDoesNotHoldTheVehicleForEver) {
  for (const bool for_ever : {false, true}) {
    auto v = corridor_vehicle();
    if (for_ever) v->config.mover_stays_after_s = 1e6;
    v->lidar.posts.push_back({{6.0, 0.9}, 0.1, 1.0});
    v->each_step = [&] { v->lidar.posts[0].at.y_m = 0.9 + 0.2 * std::sin(2.0 * kPi * v->time_s()); };
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    EXPECT_TRUE(v->run_until([&] { return v->state().block.by_mover; }, 15.0));
    EXPECT_NE(v->run_until([&] { return v->delivered(); }, 60.0), for_ever)
        << ::testing::PrintToString(v->events);
  }
}

TEST(AutonomyCycle, WhereSomethingStandsAtTheStopAPersonMayEndItBeforeIt) {
  for (const bool cleared : {false, true}) {
    auto v = corridor_vehicle();
    v->lidar.bodies.push_back({{{10.35, -0.4}, {10.35, 0.4}}, 0.05, 1.2});
    v->drive_to({{1}});
    v->say(OperatorWord::Resume);
    const auto asks = [&] { return v->state().standstill.cause.code == entry(Cause::StopTaken).code; };
    ASSERT_TRUE(v->run_until(asks, 60.0)) << v->state().standstill.cause.text;
    EXPECT_EQ(v->state().standstill.remedy, notice(Remedy::ClearOrGoOn));
    EXPECT_FALSE(v->run_until([&] { return v->delivered(); }, 20.0)) << "nobody has said so";
    ASSERT_TRUE(v->run_until(asks, 10.0));
    if (cleared)
      v->lidar.bodies.clear();
    else
      v->say(OperatorWord::GoOn);
    EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, cleared ? 20.0 : 1.0));
    EXPECT_NEAR(v->rolling.pose().x_m(), cleared ? 10.0 : 9.0, cleared ? 0.05 : 0.25);
    EXPECT_GT(v->clearance_m(), 0.0);
  }
}

/// The search beside the cycle may answer when another errand has asked its own question.
TEST(AutonomyCycle, NoTwoErrandsAskForAWayAroundByTheSameNumber) {
  auto v = corridor_vehicle();
  v->lidar.bodies.push_back({{{6.0, -0.4}, {6.0, 0.4}}, 0.4, 0.3});
  std::vector<std::uint32_t> asked;
  v->on_step = [&](const auto& /*input*/, const auto& output, const auto& /*state*/) {
    if (output.detour_wanted) asked.push_back(output.detour_wanted->id);
  };
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return !asked.empty(); }, 20.0));
  v->drive_to({{1}});
  ASSERT_TRUE(v->run_until([&] { return asked.size() > 1; }, 20.0));
  EXPECT_NE(asked[0], asked[1]);
}

TEST(AutonomyCycle, LegsThatCountAsFreeAgainAreForgotten) {
  auto v = corridor_vehicle();
  v->config.detour_after_s = v->config.back_out_after_s = v->config.squeeze_after_s = 1e6;
  v->config.reroute_after_s = 3.0;
  v->config.forget_block_s = 2.0;
  for (double y = -2.0; y < 2.0; y += 0.2) v->lidar.posts.push_back({{16.0, y}, 0.15, 1.0});
  for (double x = 12.0; x < 14.1; x += 0.2) v->lidar.posts.push_back({{x, 16.0 - x}, 0.15, 1.0});
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  std::size_t most = 0, taken = 0;
  v->on_step = [&](const auto& /*input*/, const auto& output, const auto& state) {
    most = std::max(most, state.errand.blocked_legs.size());
    taken += static_cast<std::size_t>(std::ranges::count_if(
        output.events, [](const auto& e) { return e.find("another route") != std::string::npos; }));
  };
  v->run_until([] { return false; }, 120.0);
  EXPECT_GT(taken, 2U);
  EXPECT_LE(most, 2U);
}

}  // namespace
}  // namespace madori::app
