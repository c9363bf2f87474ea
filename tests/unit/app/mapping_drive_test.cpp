// A site without a drawing: the vehicle is driven by hand through two rooms, in the virtual factory.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/cycle/site_config.hpp"
#include "app/map_comparison.hpp"
#include "app/panel/reference_lidar.hpp"
#include "app/runner/site_run.hpp"
#include "app/simulated/factory_link.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"
#include "planning/route_graph/route_check.hpp"
#include "simulation/scenario/scenario.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

const fs::path kRooms = fs::path(MADORI_SOURCE_DIR) / "data/two_rooms";
const std::vector<Point2<Map>> kRound{{5.0, 2.0}, {5.5, 4.0}, {9.5, 4.0}, {10.0, 6.3}, {10.0, 1.8},
                                      {9.5, 4.0}, {5.5, 4.0}, {3.5, 6.0}, {2.0, 3.5}};

mapping::SensorRecord planar() {
  return {"front", "lms1xx", 0.7, 0.0, 0.25, 0.0};
}

/// Hands the factory's link to one SiteRun after the other: the program is killed and started again.
class Lent final : public VehicleLink {
 public:
  explicit Lent(VehicleLink& link) : link_(link) {}
  void collect(CycleInput& input) override { link_.collect(input); }
  void send(const CycleOutput& output) override { link_.send(output); }
  [[nodiscard]] std::string problem() const override { return ""; }

 private:
  VehicleLink& link_;
};

class MappingDriveTest : public testing::Test {
 protected:
  void begin(const std::vector<mapping::SensorRecord>& sensors) {
    simulation::FactorySetup setup;
    setup.scenario = simulation::load_scenario(kRooms / "scenario.yaml");
    setup.scenario.vlp16.keep_every_firing = 4;
    setup.seed = setup.scenario.seed;
    setup.sensors = sensors;
    setup_ = {mapping::VehicleRecord{}, sensors};
    factory_ = std::make_shared<simulation::Factory>(setup);
    link_ = std::make_unique<FactoryLink>(
        factory_,
        WheelGeometry{setup_.vehicle.wheel_radius_m, setup_.vehicle.wheel_radius_m,
                      setup_.vehicle.half_wheel_separation_m},
        20ms);
    start_program();
  }
  void start_program() { run_.emplace(site_, std::make_unique<Lent>(*link_), SiteRun::Hooks{}); }
  /// As soon as the mapper listens.
  void map(bool anew) {
    run_->map_by_driving(setup_, anew);
    while (!run_->mapping() || run_->mapping()->progress().reading) {  // the test's own limit ends this
      tick();
      std::this_thread::sleep_for(1ms);
    }
  }
  void tick() {
    run_->tick(factory_->now() + 20ms);
    while (run_->mapping() && run_->mapping()->progress().waiting > 0) std::this_thread::sleep_for(1ms);
  }
  void jog(const VelocityCommand& velocity) {
    if (run_->view() && run_->view()->mode != Mode::Manual) run_->say({OperatorWord::ManualOn, {}, {}});
    run_->say({OperatorWord::Jog, velocity, {}});
  }
  void jog_for(double seconds, const VelocityCommand& velocity) {
    for (double t = 0.0; t < seconds; t += 0.02) {
      jog(velocity);
      tick();
    }
  }
  /// A person who sees the vehicle and steers it there; whether it came.
  bool drive_to(const Point2<Map>& goal, double limit_s = 60.0) {
    for (double t = 0.0; t < limit_s; t += 0.02) {
      const auto at = factory_->truth().map_from_base;
      const double dx = goal.x_m - at.x_m(), dy = goal.y_m - at.y_m();
      if (std::hypot(dx, dy) < 0.15) {
        jog_for(0.6, {});
        return true;
      }
      const double off = wrap_angle(std::atan2(dy, dx) - at.yaw_rad());
      const double ahead = std::abs(off) > 0.6 ? 0.0 : 0.5 * std::min(1.0, std::hypot(dx, dy) / 0.5);
      jog({ahead, std::clamp(1.5 * off, -0.7, 0.7)});
      tick();
    }
    return false;
  }
  void drive_round(std::size_t first = 0, std::size_t end = kRound.size()) {
    for (std::size_t i = first; i < end; ++i) ASSERT_TRUE(drive_to(kRound[i])) << i;
  }
  std::size_t finish() {
    jog_for(0.5, {});
    const auto view = *run_->view();
    return make_site_of_drive(*run_->mapping(), site_,
                              StandsAt{view.pose.map_from_base, counters_of(view.drive)},
                              [](const std::string&, double) {});
  }
  /// Mean distances between the site's walls and the true ones, both ways, metres.
  [[nodiscard]] std::pair<double, double> off_truth() const {
    MapComparisonOptions options;
    options.alignment = MapAlignment::Anywhere;
    const auto found = compare_maps(occupied_places(site_, options.cell_m),
                                    occupied_places(kRooms / "true_walls.csv", options.cell_m), options);
    return {found["map_to_building"]["mean_m"].get<double>(),
            found["building_to_map"]["mean_m"].get<double>()};
  }
  void expect_right_map(const char* which) const {
    const auto [phantoms_m, missing_m] = off_truth();
    std::printf("%s: map to building %.3f m, building to map %.3f m\n", which, phantoms_m, missing_m);
    EXPECT_LE(phantoms_m, 0.05);
    EXPECT_LE(missing_m, 0.05);
  }
  void silence(simulation::Device device) {
    simulation::FaultSpec fault;
    fault.device = device;
    fault.for_s = 3.0;
    factory_->inject(fault);
  }
  [[nodiscard]] std::string cause() const { return run_->view()->standstill.cause.code; }

  test::TemporaryFolder folder_;
  fs::path site_ = folder_.path() / "site";
  MappingSetup setup_;
  std::shared_ptr<simulation::Factory> factory_;
  std::unique_ptr<FactoryLink> link_;
  std::optional<SiteRun> run_;
};

TEST_F(MappingDriveTest, ADriveWithARevolvingLidarMakesASiteThatCanBeDrivenOn) {
  begin({reference_lidar()});
  map(true);
  EXPECT_EQ(run_->view()->mode, Mode::Paused);
  EXPECT_FALSE(fs::exists(site_ / "site.yaml"));
  drive_round();
  EXPECT_TRUE(factory_->collisions().empty());
  const auto picture = run_->mapping()->picture();
  EXPECT_GT(picture->points.size(), 200U);
  EXPECT_GT(picture->walls.size(), 4U);
  EXPECT_GT(finish(), 8U);
  expect_right_map("VLP-16");
  const mapping::Site site = mapping::load_scaled_site(site_);
  ASSERT_EQ(site.sensors.size(), 1U);
  EXPECT_EQ(site.sensors.front(), reference_lidar());

  // the way becomes routes on which an order can be driven
  const auto way = load_driven_way(site_);
  EXPECT_GT(planning::length_m(way), 20.0);
  const planning::RouteGraph routes = planning::taught({}, way);
  EXPECT_GE(routes.nodes().size(), 6U);
  std::vector<Segment2<Map>> walls;
  for (const auto& wall : mapping::load_walls(site_ / "walls.csv")) walls.push_back(wall.segment);
  for (const auto& finding : planning::check_routes(routes, walls))
    EXPECT_NE(finding.severity, planning::Severity::Error) << finding.text();

  // the vehicle knows where it stands: last_pose.yaml is of these walls, and right
  const auto last =
      load_stored_pose(site_, mapping::walls_fingerprint(mapping::load_walls(site_ / "walls.csv")));
  ASSERT_TRUE(last.pose) << last.message;
  EXPECT_LT(distance_m(last.pose->map_from_base.translation(), way.back().map_from_base.translation()), 0.1);
}

TEST_F(MappingDriveTest, APlanarLidarDoesAsWell) {
  begin({planar()});
  map(true);
  drive_round();
  EXPECT_GT(finish(), 8U);
  expect_right_map("LMS1xx");
}

TEST_F(MappingDriveTest, AnInterruptedDriveGoesOn) {
  begin({reference_lidar()});
  map(true);
  drive_round(0, 4);
  const double before_m = run_->mapping()->progress().driven_m;
  run_.reset();                                                              // the program is killed
  fs::resize_file(drive_file(site_), fs::file_size(drive_file(site_)) - 7);  // ... while it wrote
  EXPECT_TRUE(has_open_drive(site_));
  start_program();
  for (int i = 0; i < 50; ++i) tick();
  EXPECT_FALSE(run_->view());  // it waits to be asked
  map(false);
  EXPECT_NEAR(run_->mapping()->progress().driven_m, before_m, 0.1);
  drive_round(4);
  EXPECT_FALSE(run_->mapping()->progress().lost);
  EXPECT_GT(finish(), 8U);
  EXPECT_FALSE(has_open_drive(site_));
  expect_right_map("interrupted");
}

TEST_F(MappingDriveTest, ASilentLidarOrDriveLetsNothingMoveAndIsSaid) {
  begin({reference_lidar()});
  map(true);
  jog_for(1.0, {0.3, 0.0});
  EXPECT_GT(factory_->distance_driven_m(), 0.1);
  silence(simulation::Device::Vlp16);
  jog_for(1.5, {0.3, 0.0});
  const double silent_m = factory_->distance_driven_m();
  jog_for(1.0, {0.3, 0.0});
  EXPECT_NEAR(factory_->distance_driven_m(), silent_m, 1e-4);
  EXPECT_EQ(cause(), "lidar-silent");
  jog_for(2.0, {0.3, 0.0});
  EXPECT_GT(factory_->distance_driven_m(), silent_m + 0.1);
  silence(simulation::Device::Drive);
  jog_for(1.5, {0.3, 0.0});
  EXPECT_EQ(cause(), "drive-silent");
}

TEST_F(MappingDriveTest, ItStopsBeforeAWallAndByItself) {
  begin({reference_lidar()});
  map(true);
  jog_for(12.0, {0.5, 0.0});  // the wall is 4.2 m before the vehicle's front
  EXPECT_TRUE(factory_->collisions().empty());
  EXPECT_GT(factory_->distance_driven_m(), 3.5);
  EXPECT_EQ(cause(), "something-in-the-way");
  jog_for(1.0, {-0.3, 0.0});
  const double before_m = factory_->distance_driven_m();
  for (int i = 0; i < 100; ++i) tick();  // nobody holds
  EXPECT_LT(factory_->distance_driven_m(), before_m + 0.25);
  EXPECT_NEAR(factory_->truth().linear_mps, 0.0, 1e-3);
}

TEST_F(MappingDriveTest, TooLittleDrivingMakesNoSite) {
  begin({reference_lidar()});
  map(true);
  jog_for(2.0, {0.3, 0.0});
  try {
    (void)finish();
    FAIL() << "a site was made";
  } catch (const NoMap& e) {
    EXPECT_EQ(e.code, "mapping-too-short");
  }
  EXPECT_FALSE(fs::exists(site_ / "site.yaml"));
  drive_round();  // and the drive goes on
  EXPECT_GT(finish(), 8U);
}

TEST_F(MappingDriveTest, WhatFitsNothingIsToldUntilTheMapGoesOn) {
  begin({reference_lidar()});
  map(true);
  ASSERT_TRUE(drive_to(kRound[0]));
  EXPECT_FALSE(run_->mapping()->progress().lost);
  const auto known = factory_->truth().map_from_base;
  factory_->set_pose({8.2, 1.8, -1.5});  // carried into the other room, which it has not seen
  jog_for(4.0, {0.0, 0.4});
  EXPECT_TRUE(run_->mapping()->progress().lost);
  EXPECT_EQ(cause(), "mapping-lost");
  jog_for(4.0, {0.0, -0.4});
  EXPECT_TRUE(run_->mapping()->progress().lost);  // it has seen the other room by now, but that is no tie
  factory_->set_pose(known);
  jog_for(4.0, {0.0, -0.4});
  EXPECT_TRUE(run_->mapping()->progress().lost);  // one place is no tie either: a building may repeat itself
  drive_round();
  EXPECT_FALSE(run_->mapping()->progress().lost);
  EXPECT_EQ(cause(), "mapping");
}

TEST_F(MappingDriveTest, ABadSetupIsRefused) {
  begin({reference_lidar()});
  setup_.sensors.front().x_m = 4.0;
  EXPECT_THROW(run_->map_by_driving(setup_, true), Error);
  setup_ = {mapping::VehicleRecord{}, {}};
  EXPECT_THROW(run_->map_by_driving(setup_, true), Error);
  EXPECT_FALSE(has_open_drive(site_));
  fs::create_directories(site_);
  folder_.write("site/site.yaml", "madori_site: 1\n");
  setup_.sensors = {reference_lidar()};
  EXPECT_THROW(run_->map_by_driving(setup_, true), Error);
}

}  // namespace
}  // namespace madori::app
