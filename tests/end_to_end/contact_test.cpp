// Somebody lies where no lidar sees him, so near that the vehicle touches him: the bumper is pressed for a
// moment only, between two frames of the drive, and the vehicle must stand for good all the same.
#include <gtest/gtest.h>

#include "tests/support/lock_step_run.hpp"

namespace madori {
namespace {

TEST(Contact, ATouchBetweenTwoFramesHoldsTheVehicleUntilAPersonHasLooked) {
  constexpr int kStation = 7;
  const auto site = app::load_for_driving(MADORI_SAMPLE_SITE);
  auto setup = simulation::load_setup(MADORI_SAMPLE_SITE, MADORI_SAMPLE_SITE "/scenario.yaml");
  setup.scenario.movers.clear();
  test::LockStepRun run(site, setup);
  const auto order = run.orders->add({{kStation, app::StopAction::Pass, 0.0}}, 1, run.factory->now());
  ASSERT_TRUE(run.run_until(
      [&] { return run.state().mode == app::Mode::Driving && run.factory->truth().linear_mps > 0.4; },
      120.0));
  const auto& vehicle = run.factory->vehicle().record();
  simulation::MoverSpec body;
  body.kind = simulation::MoverKind::LyingBody;
  body.name = "lying";
  body.start_s = 1e9;
  const double front_m = vehicle.length_m - vehicle.base_to_rear_m;
  for (const double side_m : {0.0, 0.1}) {  // two points give him his direction: across the way
    const Point2<Map> at = run.factory->truth().map_from_base * Point2<Base>{front_m + 0.35, side_m};
    body.path.push_back(run.factory->world().frames().map_from_plan.inverse() * at);
  }
  run.factory->add_mover(body);
  ASSERT_TRUE(run.run_until([&] { return !run.factory->collisions().empty(); }, 5.0));
  EXPECT_TRUE(run.run_until([&] { return run.state().mode == app::Mode::EmergencyStop; }, 0.1));
  run.run_until([] { return false; }, 10.0);
  EXPECT_EQ(run.state().mode, app::Mode::EmergencyStop);
  EXPECT_EQ(run.state().standstill.cause.code, app::notice(app::Cause::EmergencyStopOver).code);
  EXPECT_EQ(run.factory->collisions().size(), 1U);
  EXPECT_NE(run.orders->find(order)->state, app::OrderState::Done);
}

}  // namespace
}  // namespace madori
