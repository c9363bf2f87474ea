#include <gtest/gtest.h>

#include "tests/unit/app/corridor_vehicle.hpp"

namespace madori::app {
namespace {

using test::corridor_vehicle;

TEST(AutonomyCycle, NothingMovesUntilTheOperatorLetsIt) {
  auto v = corridor_vehicle();
  v->drive_to({{2}});
  EXPECT_FALSE(v->run_until([&] { return v->rolling.speed().linear_mps != 0.0; }, 5.0));
  EXPECT_EQ(v->state().mode, Mode::Paused);
  EXPECT_EQ(v->state().standstill.remedy.text, "press Resume");
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.5; }, 5.0));
}

TEST(AutonomyCycle, AnOrderIsDeliveredAndTheGoalIsMetInPlaceAndHeading) {
  auto v = corridor_vehicle();
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

TEST(AutonomyCycle, WhoStandsAtTheStopAlreadyTurnsToItsHeading) {
  for (const double off_deg : {10.0, 30.0, 40.0}) {
    auto v = corridor_vehicle();
    v->rolling.set_pose({22.0, 0.0, to_rad(90.0 - off_deg)});
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    ASSERT_TRUE(v->run_until([&] { return v->delivered(); }, 20.0)) << off_deg;
    EXPECT_NEAR(to_deg(v->rolling.pose().yaw_rad()), 90.0, 1.0);
  }
}

/// Beyond the end of its way, or beside it, is not at the stop.
TEST(AutonomyCycle, WhatIsDrivenPastTheStopByHandIsNotDelivered) {
  for (const double past_m : {0.3, 0.55, 0.7}) {
    auto v = corridor_vehicle();
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    ASSERT_TRUE(v->run_until([&] { return v->rolling.pose().x_m() > 20.5; }, 60.0));
    v->say(OperatorWord::ManualOn);
    v->run_until([] { return false; }, 1.0);
    v->rolling.set_pose({22.0 + past_m * 0.8, past_m * 0.6, 0.0});
    v->say(OperatorWord::ManualOff);
    v->say(OperatorWord::Resume);
    ASSERT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0)) << v->state().standstill.cause.text;
    EXPECT_LT(distance_m(v->rolling.pose().translation(), Point2<Map>{22.0, 0.0}), 0.05) << past_m;
  }
}

TEST(AutonomyCycle, AnUnknownNodeIsRefusedAndSaidSo) {
  auto v = corridor_vehicle();
  v->drive_to({{99}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->output.order_refused.has_value(); }, 2.0));
  EXPECT_EQ(v->output.order_refused->second, "node 99 is not in the routes");
}

TEST(AutonomyCycle, ManualModeFollowsTheHeldKeyAndStopsWithoutIt) {
  auto v = corridor_vehicle();
  v->step();  // commands that do not enable the drive arm it
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

TEST(AutonomyCycle, WhoeverStopsItIsObeyedAlsoByHandAndItIsSaidWhatHasEnded) {
  for (const OperatorWord word : {OperatorWord::Stop, OperatorWord::Halt}) {
    auto v = corridor_vehicle();
    v->drive_to({{2}});
    v->say(OperatorWord::Resume);
    ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.5; }, 10.0));
    v->say(word);
    v->step();
    EXPECT_EQ(v->output.command, VelocityCommand{});
    EXPECT_EQ(v->state().mode, Mode::Paused);
    EXPECT_EQ(v->state().standstill.cause.code,
              entry(word == OperatorWord::Stop ? Cause::StoppedOrder : Cause::Stopped).code);
    v->say(OperatorWord::ManualOn);
    v->commands.push_back({OperatorWord::Jog, {0.3, 0.0}});
    v->run_until([&] { return false; }, 0.2);
    ASSERT_GT(v->output.command.linear_mps, 0.0);
    v->say(word);
    v->step();
    EXPECT_EQ(v->output.command, VelocityCommand{}) << "also the key that is still held";
    EXPECT_EQ(v->state().mode, Mode::Paused);
    v->say(OperatorWord::Resume);
    EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
  }
}

TEST(AutonomyCycle, APlaceThatAPersonGivesReachesLocalization) {
  auto v = corridor_vehicle();
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
  auto v = corridor_vehicle();
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

/// On its way to unload at node 1.
std::unique_ptr<test::ToyVehicle> sure_to_80_percent() {
  auto v = corridor_vehicle();
  v->pose->state = LocalizationState::Degraded;
  v->pose->place = 0.8;
  v->drive_to({{1, StopAction::Unload, 0.5}});
  v->say(OperatorWord::Resume);
  return v;
}

TEST(AutonomyCycle, AStopAtAPlaceThatIsNotCertainIsHandedOverOnlyWhenSomebodyLooked) {
  const auto v = sure_to_80_percent();
  const Notice asks = notice(Cause::StopUnsure, {{"node", "1"}, {"percent", "80"}});
  ASSERT_TRUE(v->run_until([&] { return v->state().standstill.cause == asks; }, 60.0));
  EXPECT_EQ(v->state().standstill.remedy, notice(Remedy::LookAtPlace));
  EXPECT_FALSE(v->run_until([&] { return v->delivered(); }, 30.0));
  v->say(OperatorWord::GoOn);
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 1.0));
}

TEST(AutonomyCycle, AStopIsHandedOverByItselfOnceThePlaceIsCertain) {
  const auto v = sure_to_80_percent();
  ASSERT_TRUE(v->run_until([&] { return v->state().errand.arrived; }, 60.0));
  EXPECT_FALSE(v->run_until([&] { return v->delivered(); }, 5.0));
  v->pose->place = 0.97;
  EXPECT_TRUE(v->run_until([&] { return v->delivered(); }, 1.0));
}

/// It stood 3 m before the stop and took it for the stop; then somebody shows it the place.
TEST(AutonomyCycle, APoseThatIsCorrectedAtAStopSendsTheVehicleOnToIt) {
  auto v = corridor_vehicle();
  v->drive_to({{1, StopAction::Unload, 20.0}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->state().errand.arrived; }, 60.0));
  v->rolling.set_pose({7.0, 0.0, 0.0});
  EXPECT_FALSE(v->run_until([&] { return v->delivered(); }, 15.0));
  ASSERT_TRUE(v->run_until([&] { return v->delivered(); }, 60.0));
  EXPECT_NEAR(v->rolling.pose().x_m(), 10.0, 0.05);
}

/// More waypoints than a path may have: no reason to hand the goods over where the vehicle stands.
TEST(AutonomyCycle, AWayThatIsTooLongForAPathIsRefusedAndNothingIsHandedOver) {
  auto routes = planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,0,0\n1,400000,0\n");
  test::ToyVehicle v(test::toy_config(std::move(routes.graph)), {0.0, 0.0, 0.0});
  v.drive_to({{1}});
  v.say(OperatorWord::Resume);
  ASSERT_TRUE(v.run_until([&] { return v.output.order_refused || v.output.stop_done; }, 2.0));
  EXPECT_FALSE(v.output.stop_done);
  EXPECT_TRUE(v.output.order_refused);
}

}  // namespace
}  // namespace madori::app
