// A vehicle whose only lidar is asked for its scans, in the sample factory: the device's bytes, the real
// localization, the whole cycle in lock-step. It finds its place, drives as fast as its rate allows, and
// touches nothing.
#include <gtest/gtest.h>

#include <algorithm>

#include "app/lidars.hpp"
#include "tests/support/lock_step_run.hpp"

namespace madori {
namespace {

struct Polled {
  const char* poll_hz;
  double fastest_mps;  ///< docs/explanation/lidars.md, Polling
};

class PolledLidar : public testing::TestWithParam<Polled> {};

TEST_P(PolledLidar, FindsItsPlaceAndDeliversSlowly) {
  constexpr int kStation = 7;  // on this side of door and lift, whose height no planar lidar sees
  auto site = app::load_for_driving(MADORI_SAMPLE_SITE);
  auto setup = simulation::load_setup(MADORI_SAMPLE_SITE, MADORI_SAMPLE_SITE "/scenario.yaml");
  setup.scenario.movers.clear();
  setup.sensors = {{"front", "lms1xx", 0.75, 0.0, 0.25, 0.0}};
  setup.sensors.front().settings["poll_hz"] = GetParam().poll_hz;
  site.site.sensors = setup.sensors;
  auto config = app::vehicle_config(site.site.vehicle, app::lidars_of(site.site, MADORI_SAMPLE_SITE));
  config.routes = site.config.routes;
  config.walls = site.config.walls;
  site.config = std::move(config);
  test::LockStepRun run(site, setup);
  ASSERT_TRUE(
      run.run_until([&] { return run.state().pose.health.state == LocalizationState::Localized; }, 120.0))
      << run.state().pose.health.reason;
  const auto order = run.orders->add({{kStation, app::StopAction::Pass, 0.0}}, 1, run.factory->now());
  double fastest_mps = 0.0;
  const bool delivered = run.run_until(
      [&] {
        fastest_mps = std::max(fastest_mps, run.run->view().command.linear_mps);
        return run.orders->find(order)->state == app::OrderState::Done;
      },
      400.0);
  EXPECT_TRUE(delivered) << to_string(run.state().mode) << ", " << run.state().standstill.cause.text;
  EXPECT_LT(fastest_mps, 1.01 * GetParam().fastest_mps);
  EXPECT_GT(fastest_mps, 0.1);
  EXPECT_TRUE(run.factory->collisions().empty());
  std::printf("asked %s times a second: at most %.2f m/s, %.0f s\n", GetParam().poll_hz, fastest_mps,
              run.time_s());
}

INSTANTIATE_TEST_SUITE_P(Rates, PolledLidar, testing::Values(Polled{"2", 1.51}, Polled{"0.3", 0.64}));

}  // namespace
}  // namespace madori
