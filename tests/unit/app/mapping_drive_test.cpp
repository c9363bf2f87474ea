// A site without a drawing: the vehicle is driven by hand through two rooms, in the virtual factory.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/panel/reference_lidar.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"
#include "planning/route_graph/route_check.hpp"
#include "simulation/scenario/scenario.hpp"
#include "tests/support/hand_drive.hpp"
#include "tests/support/mapping_trial.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

const fs::path kRooms = fs::path(MADORI_SOURCE_DIR) / "data/two_rooms";
const std::vector<Point2<Map>> kRound{{5.0, 2.0}, {5.5, 4.0}, {9.5, 4.0}, {10.0, 6.3}, {10.0, 1.8},
                                      {9.5, 4.0}, {5.5, 4.0}, {3.5, 6.0}, {2.0, 3.5}};

mapping::SensorRecord planar() {
  return {"front", "lms1xx", 0.7, 0.0, 0.25, 0.0};
}

class MappingDriveTest : public testing::Test {
 protected:
  void begin(const std::vector<mapping::SensorRecord>& sensors) {
    simulation::FactorySetup setup;
    setup.scenario = simulation::load_scenario(kRooms / "scenario.yaml");
    setup.scenario.vlp16.keep_every_firing = 4;
    setup.seed = setup.scenario.seed;
    setup.sensors = sensors;
    drive_.emplace(setup);
  }
  [[nodiscard]] SiteRun& run() { return drive_->run(); }
  [[nodiscard]] simulation::Factory& factory() { return drive_->factory(); }
  void drive_round(std::size_t first = 0, std::size_t end = kRound.size()) {
    for (std::size_t i = first; i < end; ++i) ASSERT_TRUE(drive_->drive_to(kRound[i])) << i;
  }
  void expect_right_map(const char* which) const {
    const auto found = test::compared_with_rooms(drive_->site());
    const double phantoms_m = found["map_to_building"]["mean_m"];
    const double missing_m = found["building_to_map"]["mean_m"];
    std::printf("%s: map to building %.3f m, building to map %.3f m\n", which, phantoms_m, missing_m);
    EXPECT_LE(phantoms_m, 0.03);
    EXPECT_LE(missing_m, 0.03);
  }
  void silence(simulation::Device device) {
    simulation::FaultSpec fault;
    fault.device = device;
    fault.for_s = 3.0;
    factory().inject(fault);
  }
  [[nodiscard]] std::string cause() { return run().view()->standstill.cause.code; }

  std::optional<test::HandDrive> drive_;
};

TEST_F(MappingDriveTest, ADriveWithARevolvingLidarMakesASiteThatCanBeDrivenOn) {
  begin({reference_lidar()});
  drive_->map(true);
  EXPECT_EQ(run().view()->mode, Mode::Paused);
  EXPECT_FALSE(fs::exists(drive_->site() / "site.yaml"));
  drive_round();
  EXPECT_TRUE(factory().collisions().empty());
  const auto picture = run().mapping()->picture();
  EXPECT_GT(picture->points.size(), 200U);
  EXPECT_GT(picture->walls.size(), 4U);
  EXPECT_GT(drive_->finish(), 8U);
  expect_right_map("VLP-16");
  const mapping::Site site = mapping::load_scaled_site(drive_->site());
  ASSERT_EQ(site.sensors.size(), 1U);
  EXPECT_EQ(site.sensors.front(), reference_lidar());

  // the way becomes routes on which an order can be driven
  const auto way = load_driven_way(drive_->site());
  EXPECT_GT(planning::length_m(way), 20.0);
  const planning::RouteGraph routes = planning::taught({}, way);
  EXPECT_GE(routes.nodes().size(), 6U);
  std::vector<Segment2<Map>> walls;
  for (const auto& wall : mapping::load_walls(drive_->site() / "walls.csv")) walls.push_back(wall.segment);
  for (const auto& finding : planning::check_routes(routes, walls))
    EXPECT_NE(finding.severity, planning::Severity::Error) << finding.text();

  // the vehicle knows where it stands: last_pose.yaml is of these walls, and right
  const auto last = load_stored_pose(
      drive_->site(), mapping::walls_fingerprint(mapping::load_walls(drive_->site() / "walls.csv")));
  ASSERT_TRUE(last.pose) << last.message;
  EXPECT_LT(distance_m(last.pose->map_from_base.translation(), way.back().map_from_base.translation()), 0.1);
}

TEST_F(MappingDriveTest, APlanarLidarDoesAsWell) {
  begin({planar()});
  drive_->map(true);
  drive_round();
  EXPECT_GT(drive_->finish(), 8U);
  expect_right_map("LMS1xx");
}

TEST_F(MappingDriveTest, AnInterruptedDriveGoesOn) {
  begin({reference_lidar()});
  drive_->map(true);
  drive_round(0, 4);
  const double before_m = run().mapping()->progress().driven_m;
  drive_->kill_program();  // the program is killed
  fs::resize_file(drive_file(drive_->site()),
                  fs::file_size(drive_file(drive_->site())) - 7);  // ... while it wrote
  EXPECT_TRUE(has_open_drive(drive_->site()));
  drive_->start_program();
  for (int i = 0; i < 50; ++i) drive_->tick();
  EXPECT_FALSE(run().view());  // it waits to be asked
  drive_->map(false);
  EXPECT_NEAR(run().mapping()->progress().driven_m, before_m, 0.1);
  drive_round(4);
  EXPECT_FALSE(run().mapping()->progress().lost);
  EXPECT_GT(drive_->finish(), 8U);
  EXPECT_FALSE(has_open_drive(drive_->site()));
  expect_right_map("interrupted");
}

TEST_F(MappingDriveTest, ASilentLidarOrDriveLetsNothingMoveAndIsSaid) {
  begin({reference_lidar()});
  drive_->map(true);
  drive_->jog_for(1.0, {0.3, 0.0});
  EXPECT_GT(factory().distance_driven_m(), 0.1);
  silence(simulation::Device::Vlp16);
  drive_->jog_for(1.5, {0.3, 0.0});
  const double silent_m = factory().distance_driven_m();
  drive_->jog_for(1.0, {0.3, 0.0});
  EXPECT_NEAR(factory().distance_driven_m(), silent_m, 1e-4);
  EXPECT_EQ(cause(), "lidar-silent");
  drive_->jog_for(2.0, {0.3, 0.0});
  EXPECT_GT(factory().distance_driven_m(), silent_m + 0.1);
  silence(simulation::Device::Drive);
  drive_->jog_for(1.5, {0.3, 0.0});
  EXPECT_EQ(cause(), "drive-silent");
}

TEST_F(MappingDriveTest, ItStopsBeforeAWallAndByItself) {
  begin({reference_lidar()});
  drive_->map(true);
  drive_->jog_for(12.0, {0.5, 0.0});  // the wall is 4.2 m before the vehicle's front
  EXPECT_TRUE(factory().collisions().empty());
  EXPECT_GT(factory().distance_driven_m(), 3.5);
  EXPECT_EQ(cause(), "something-in-the-way");
  drive_->jog_for(1.0, {-0.3, 0.0});
  const double before_m = factory().distance_driven_m();
  for (int i = 0; i < 100; ++i) drive_->tick();  // nobody holds
  EXPECT_LT(factory().distance_driven_m(), before_m + 0.25);
  EXPECT_NEAR(factory().truth().linear_mps, 0.0, 1e-3);
}

TEST_F(MappingDriveTest, TooLittleDrivingMakesNoSite) {
  begin({reference_lidar()});
  drive_->map(true);
  drive_->jog_for(2.0, {0.3, 0.0});
  try {
    (void)drive_->finish();
    FAIL() << "a site was made";
  } catch (const NoMap& e) {
    EXPECT_EQ(e.code, "mapping-too-short");
  }
  EXPECT_FALSE(fs::exists(drive_->site() / "site.yaml"));
  drive_round();  // and the drive goes on
  EXPECT_GT(drive_->finish(), 8U);
}

TEST_F(MappingDriveTest, WhatFitsNothingIsToldUntilTheMapGoesOn) {
  begin({reference_lidar()});
  drive_->map(true);
  ASSERT_TRUE(drive_->drive_to(kRound[0]));
  EXPECT_FALSE(run().mapping()->progress().lost);
  const auto known = factory().truth().map_from_base;
  factory().set_pose({8.2, 1.8, -1.5});  // carried into the other room, which it has not seen
  drive_->jog_for(4.0, {0.0, 0.4});
  EXPECT_TRUE(run().mapping()->progress().lost);
  EXPECT_EQ(cause(), "mapping-lost");
  drive_->jog_for(4.0, {0.0, -0.4});
  EXPECT_TRUE(run().mapping()->progress().lost);  // it has seen the other room by now, but that is no tie
  factory().set_pose(known);
  drive_->jog_for(4.0, {0.0, -0.4});
  EXPECT_TRUE(run().mapping()->progress().lost);  // one place is no tie either: a building may repeat itself
  drive_round();
  EXPECT_FALSE(run().mapping()->progress().lost);
  EXPECT_EQ(cause(), "mapping");
}

TEST_F(MappingDriveTest, ABadSetupIsRefused) {
  begin({reference_lidar()});
  drive_->setup().sensors.front().x_m = 4.0;
  EXPECT_THROW(run().map_by_driving(drive_->setup(), true), Error);
  drive_->setup() = {mapping::VehicleRecord{}, {}};
  EXPECT_THROW(run().map_by_driving(drive_->setup(), true), Error);
  EXPECT_FALSE(has_open_drive(drive_->site()));
  fs::create_directories(drive_->site());
  drive_->folder().write("site/site.yaml", "madori_site: 1\n");
  drive_->setup().sensors = {reference_lidar()};
  EXPECT_THROW(run().map_by_driving(drive_->setup(), true), Error);
}

}  // namespace
}  // namespace madori::app
