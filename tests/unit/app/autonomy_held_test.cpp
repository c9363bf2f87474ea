#include <gtest/gtest.h>

#include "tests/unit/app/corridor_vehicle.hpp"

// A vehicle that drives and does not get on: slipping wheels, or something that no sensor sees.
namespace madori::app {
namespace {

using test::corridor_vehicle;

TEST(AutonomyCycle, AVehicleThatDrivesAndDoesNotGetOnStopsAndSaysSo) {
  using Held = test::RollingVehicle::Held;
  for (const Held how : {Held::Slipping, Held::Blocked}) {
    auto v = corridor_vehicle();
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

/// Who paused it and looked says the same as who found it waiting.
TEST(AutonomyCycle, ResumeAfterAPauseForgetsWhatHeldIt) {
  auto v = corridor_vehicle();
  v->drive_to({{2}});
  v->say(OperatorWord::Resume);
  ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.9; }, 10.0));
  v->rolling.held = test::RollingVehicle::Held::Blocked;
  ASSERT_TRUE(v->run_until([&] { return v->state().standstill.cause == notice(Cause::HeldBack); }, 4.0));
  v->say(OperatorWord::Pause);
  v->run_until([&] { return false; }, 0.5);
  v->rolling.held = test::RollingVehicle::Held::No;
  v->say(OperatorWord::Resume);
  EXPECT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.3; }, 3.0));
}

/// To slipping wheels somebody who stands there seems to move: the vehicle stops and starts, and still
/// notices.
TEST(AutonomyCycle, ShortStopsDoNotHideThatItDoesNotGetOn) {
  auto v = corridor_vehicle();
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
  auto v = corridor_vehicle();
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
  auto v = corridor_vehicle();
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

}  // namespace
}  // namespace madori::app
