// What a site says of its vehicle rules everything that drives.
#include "app/cycle/site_config.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "mapping/site/site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

CycleConfig config_of(const mapping::VehicleRecord& vehicle, bool shortest = false) {
  const test::TemporaryFolder folder;
  mapping::Site site;
  site.name = "hall";
  site.drawing = {"a.png", 400, 200, 1, 0.0};
  site.scale = mapping::ScaleRecord{0.05, "known", 0.0, 0.0, "", {}, {}};
  site.vehicle = vehicle;
  site.sensors.push_back({"top", "vlp16", 0.3, 0.0, 1.2, 0.0});
  site.shortest_routes = shortest;
  mapping::save_site(folder.path(), site);
  std::filesystem::create_directories(folder.path() / "routes");
  folder.write("walls.csv", "id,x1,y1,x2,y2\n1,0,0,20,0\n");
  folder.write("routes/path.csv", "ID,x,y\n1,2,5\n2,9,5\n");
  folder.write("routes/tree.csv", "ID,EDA\n1,2\n2,1\n");
  return load_for_driving(folder.path()).config;
}

TEST(SiteConfig, SmallWheelsTurnFastButNotFasterThanACommandCanSay) {
  mapping::VehicleRecord vehicle;
  vehicle.wheel_radius_m = 0.03;
  const CycleConfig config = config_of(vehicle);
  EXPECT_GT(config.odometry.max_wheel_speed_radps, config.limits.max_wheel_speed_mps / 0.03);
  vehicle.wheel_radius_m = 0.005;
  EXPECT_THROW((void)config_of(vehicle), Error);
}

TEST(SiteConfig, NobodyCountsOnSeeingWhereNobodyLooks) {
  mapping::VehicleRecord vehicle;
  vehicle.max_speed_mps = 5.0;
  const CycleConfig config = config_of(vehicle);
  EXPECT_LE(config.sure_range_m, config.looked_at_m());
  EXPECT_LE(config.check.braking.horizon_m(config.check.braking.speed_within(config.sure_range_m)),
            config.looked_at_m() + 1e-6);
}

TEST(SiteConfig, WeakAndSlowBrakesLengthenTheWayToStand) {
  const CycleConfig usual = config_of({});
  mapping::VehicleRecord vehicle;
  vehicle.max_deceleration_mps2 = 0.4;
  vehicle.reaction_s = 0.5;
  vehicle.max_turn_acceleration_radps2 = 0.6;
  const CycleConfig weak = config_of(vehicle);
  // d = v t + v^2 / 2a, with the sweep of 0.1 s
  EXPECT_NEAR(usual.check.braking.horizon_m(1.0), 0.35 + 1.0 / 1.6, 1e-9);
  EXPECT_NEAR(weak.check.braking.horizon_m(1.0), 0.6 + 1.0 / 0.8, 1e-9);
  EXPECT_NEAR(planning::ends_margin_m(usual.check, 0.3), 0.06 + 0.35 * 0.3, 1e-9);
  EXPECT_NEAR(planning::ends_margin_m(weak.check, 0.2), 0.06 + 0.6 * 0.2, 1e-9);
  EXPECT_LT(weak.pursuit.speed.speed_to_stop_within(1.0), usual.pursuit.speed.speed_to_stop_within(1.0));
  EXPECT_LT(weak.pursuit.speed.deceleration_mps2, weak.check.braking.deceleration_mps2)
      << "a comfortable stop";
  EXPECT_LE(weak.pursuit.turn_acceleration_radps2, weak.check.braking.turn_deceleration_radps2);
  EXPECT_EQ(weak.limits.turn_acceleration_radps2, 0.6);
}

TEST(SiteConfig, WhatIsDrivenUnderIsHigherThanVehicleAndLidar) {
  mapping::VehicleRecord tall;
  tall.height_m = 1.8;
  EXPECT_NEAR(config_of({}).field.top_m, 1.3, 1e-9) << "the lidar at 1.2 m";
  EXPECT_NEAR(config_of(tall).field.top_m, 1.9, 1e-9);
}

TEST(SiteConfig, RoutesAreChosenAsTheSiteSays) {
  EXPECT_EQ(config_of({}).metric, planning::RouteMetric::Hops);
  EXPECT_EQ(config_of({}, true).metric, planning::RouteMetric::Metres);
}

}  // namespace
}  // namespace madori::app
