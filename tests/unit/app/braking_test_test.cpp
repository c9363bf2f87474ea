// The braking test in the virtual factory, by the devices' own bytes: what is measured against what the
// virtual vehicle is made to do.
#include "app/braking/braking_test.hpp"

#include <gtest/gtest.h>

#include "app/braking/braking_desk.hpp"
#include "app/braking/braking_verdict.hpp"
#include "core/result.hpp"
#include "tests/support/lock_step_run.hpp"
#include "tests/support/small_hall.hpp"
#include "tests/unit/app/corridor_vehicle.hpp"

namespace madori::app {
namespace {

constexpr double kHallM = 20.0;

/// A hall of 20 m by 12 m whose walls are drawn, with a vehicle of this record in it.
SiteForDriving site_of(const mapping::VehicleRecord& vehicle) {
  const test::TemporaryFolder folder;
  mapping::Site site;
  site.name = "hall";
  site.drawing = {"a.png", 400, 240, 1, 0.0};
  site.scale = mapping::ScaleRecord{0.05, "known", 0.0, 0.0, "", {}, {}};
  site.vehicle = vehicle;
  site.sensors.push_back({"top", "vlp16", 0.3, 0.0, 1.2, 0.0});
  mapping::save_site(folder.path(), site);
  std::filesystem::create_directories(folder.path() / "routes");
  folder.write("walls.csv", "id,x1,y1,x2,y2\n1,0,0,20,0\n2,20,0,20,12\n3,20,12,0,12\n4,0,12,0,0\n");
  folder.write("routes/path.csv", "ID,x,y\n1,2,6\n2,18,6\n");
  folder.write("routes/tree.csv", "ID,EDA\n1,2\n2,1\n");
  return load_for_driving(folder.path());
}

/// A vehicle at (x, 6) that looks along the hall, and a desk that looks on.
struct Hall {
  explicit Hall(const mapping::VehicleRecord& record, const simulation::VehicleSpec& really, double x_m = 3.0)
      : site(site_of(record)), run(site, setup_of(record, really, x_m)) {
    run.run->set_tap([this](const auto& input, const auto& /*output*/, const auto& state) {
      for (const auto& word : desk.after_step(input, state, site.config)) run.run->say(word);
    });
    run.run_until([] { return false; }, 1.0);  // devices are heard
  }
  static simulation::FactorySetup setup_of(const mapping::VehicleRecord& record,
                                           const simulation::VehicleSpec& really, double x_m) {
    auto setup = test::small_hall(kHallM, 12.0, x_m, 6.0);
    setup.vehicle = record;
    setup.sensors = {{"top", "vlp16", 0.3, 0.0, 1.2, 0.0}};
    setup.scenario.vehicle = really;
    setup.scenario.vlp16.keep_every_firing = 3;
    return setup;
  }
  bool ends() {
    return run.run_until([&] { return !desk.view().running; }, 120.0);
  }

  SiteForDriving site;
  test::LockStepRun run;
  BrakingDesk desk;
};

simulation::VehicleSpec as_recorded() {
  simulation::VehicleSpec spec;
  spec.as_recorded = true;
  return spec;
}

TEST(BrakingTest, MeasuresWhatTheVehicleDoes) {
  for (const double deceleration : {0.5, 1.5})
    for (const double reaction_s : {0.1, 0.4}) {
      SCOPED_TRACE(std::to_string(deceleration) + " m/s2, " + std::to_string(reaction_s) + " s");
      mapping::VehicleRecord record;
      record.max_deceleration_mps2 = deceleration;
      record.reaction_s = reaction_s;
      Hall hall(record, as_recorded());
      const auto begun = hall.run.factory->truth().map_from_base.translation();
      ASSERT_TRUE(hall.desk.start({1.0, BrakingDesk::kStops}, false));
      EXPECT_FALSE(hall.desk.start({1.0, 1}, true)) << "one at a time";
      ASSERT_TRUE(hall.ends());
      const auto view = hall.desk.view();
      EXPECT_EQ(view.trouble.text, "");
      ASSERT_EQ(view.stops.size(), 3U);
      for (const auto& [loaded, stop] : view.stops) {
        EXPECT_NEAR(stop.deceleration_mps2, deceleration, 0.05 * deceleration);
        EXPECT_NEAR(stop.latency_s, hall.run.factory->vehicle().dead_time_s(), 0.02);
        EXPECT_NEAR(stop.speed_mps, 1.0, 0.02);
      }
      EXPECT_LT(distance_m(hall.run.factory->truth().map_from_base.translation(), begun), 0.3);
      hall.run.run_until([] { return false; }, 0.5);
      EXPECT_EQ(hall.run.state().mode, Mode::Paused) << "and stays there";
      EXPECT_TRUE(hall.run.factory->collisions().empty());
    }
}

TEST(BrakingTest, ARecordThatPromisesTooMuchIsFoundOut) {
  simulation::VehicleSpec weak;
  weak.braking_mps2 = 0.45;
  weak.dead_time_s = 0.35;
  weak.motor_lag_s = 0.0;
  Hall hall({}, weak);  // the record: 0.8 m/s2
  ASSERT_TRUE(hall.desk.start({0.8, BrakingDesk::kStops}, true));
  ASSERT_TRUE(hall.ends());
  const auto view = hall.desk.view();
  EXPECT_EQ(view.trouble.text, "") << hall.run.state().standstill.cause.text;
  ASSERT_EQ(view.stops.size(), 3U);
  const auto verdict = verdict_of(view.stops, braking_site(hall.site.config));
  ASSERT_TRUE(verdict);
  EXPECT_NEAR(verdict->deceleration_mps2, 0.45, 0.05 * 0.45 + 0.005);
  EXPECT_NEAR(verdict->reaction_s, 0.35 + 0.02, 0.025);
}

TEST(BrakingDesk, ForgetsTheStopsOfWheelsThatWereCorrected) {
  Hall hall({}, as_recorded());
  ASSERT_TRUE(hall.desk.start({0.5, 1}, false));
  ASSERT_TRUE(hall.ends());
  ASSERT_EQ(hall.desk.view().stops.size(), 1U);
  CycleConfig corrected = hall.site.config;
  (void)hall.desk.after_step({}, hall.run.state(), corrected);
  EXPECT_EQ(hall.desk.view().stops.size(), 1U);
  corrected.odometry.wheels.left_radius_m *= 1.1;
  (void)hall.desk.after_step({}, hall.run.state(), corrected);
  EXPECT_TRUE(hall.desk.view().stops.empty());
}

TEST(BrakingTest, TheWayMustBeFree) {
  Hall hall({}, as_recorded(), 16.5);
  ASSERT_TRUE(hall.desk.start({1.0, BrakingDesk::kStops}, false));
  ASSERT_TRUE(hall.ends());
  EXPECT_EQ(hall.desk.view().trouble.code, "no-room");
  EXPECT_NEAR(std::stod(hall.desk.view().trouble.values.at("free")), 20.0 - 16.5 - 0.8, 0.15);
  EXPECT_EQ(hall.run.factory->distance_driven_m(), 0.0);
}

TEST(BrakingTest, WhatIsTooFarToBeSeenIsNotFree) {
  Hall hall({}, as_recorded());
  const CycleConfig& config = hall.site.config;
  const double seen_m = config.field.reach_m - config.check.vehicle.front_m;
  double speed_mps = 0.5;
  while (braking_test_way_m(speed_mps, config) < seen_m) speed_mps += 0.01;
  ASSERT_LT(braking_test_way_m(speed_mps, config), config.field.reach_m);
  ASSERT_TRUE(hall.desk.start({speed_mps, 1}, false));
  ASSERT_TRUE(hall.ends());
  EXPECT_EQ(hall.desk.view().trouble.code, "no-room");
  EXPECT_EQ(hall.run.factory->distance_driven_m(), 0.0);
}

TEST(BrakingTest, WhoeverComesIntoTheWayOrPressesStopEndsIt) {
  for (const bool pressed : {false, true}) {
    Hall hall({}, as_recorded());
    ASSERT_TRUE(hall.desk.start({1.0, BrakingDesk::kStops}, false));
    ASSERT_TRUE(hall.run.run_until([&] { return hall.run.factory->truth().linear_mps > 0.6; }, 20.0));
    if (pressed) {
      hall.run.run->say({OperatorWord::Stop, {}, {}});
    } else {
      simulation::MoverSpec person;
      person.name = "person";
      const double ahead_m = hall.run.factory->truth().map_from_base.x_m() + 0.8 + 1.6;
      person.path = {{ahead_m, 6.0}};
      hall.run.factory->add_mover(person);
    }
    ASSERT_TRUE(hall.ends());
    EXPECT_EQ(hall.desk.view().trouble.code, pressed ? "ended" : "something-came");
    EXPECT_TRUE(hall.desk.view().stops.empty());
    ASSERT_TRUE(hall.run.run_until([&] { return hall.run.stands(); }, 5.0));
    EXPECT_TRUE(hall.run.factory->collisions().empty());
    hall.run.run_until([] { return false; }, 1.0);
    EXPECT_EQ(hall.run.state().mode, Mode::Paused);
  }
}

/// Brakes so weak that the cycle takes the wheels for faulty: just then a person presses Stop.
TEST(BrakingTest, StopEndsItWhileTheBrakesFailToo) {
  simulation::VehicleSpec weak;
  weak.braking_mps2 = 0.22;
  weak.dead_time_s = 0.35;
  weak.motor_lag_s = 0.0;
  Hall hall({}, weak);
  ASSERT_TRUE(hall.desk.start({0.8, BrakingDesk::kStops}, true));
  ASSERT_TRUE(hall.run.run_until([&] { return hall.run.state().mode == Mode::Fault; }, 30.0));
  hall.run.run->say({OperatorWord::Stop, {}, {}});
  ASSERT_TRUE(hall.run.run_until([&] { return hall.run.stands(); }, 8.0));
  const double driven_m = hall.run.factory->distance_driven_m();
  hall.run.run_until([] { return false; }, 20.0);
  EXPECT_FALSE(hall.desk.view().running);
  EXPECT_EQ(hall.desk.view().trouble.code, "ended");
  EXPECT_NEAR(hall.run.factory->distance_driven_m(), driven_m, 0.01);
}

/// By hand a person goes on without a lidar, and out of a protective field; the test has nobody who looks.
TEST(BrakingTest, ASilentLidarOrAProtectiveFieldEndsIt) {
  for (const bool silent : {true, false}) {
    auto v = test::corridor_vehicle();
    v->run_until([] { return false; }, 1.0);  // devices are heard
    BrakingTest braking({0.5, 1});
    v->on_step = [&](const auto& input, const auto& /*output*/, const auto& state) {
      for (const auto& word : braking.after_step(input, state, v->config)) v->commands.push_back(word);
    };
    ASSERT_TRUE(v->run_until([&] { return v->rolling.speed().linear_mps > 0.3; }, 10.0));
    (silent ? v->lidar_silent : v->protective_stop) = true;
    EXPECT_TRUE(v->run_until([&] { return braking.ended(); }, 0.6));
    EXPECT_EQ(braking.trouble().code, silent ? "no-lidar" : "ended");
    v->run_until([] { return false; }, 1.5);
    EXPECT_NEAR(v->rolling.speed().linear_mps, 0.0, 0.01);
    EXPECT_EQ(v->state().mode, Mode::Paused);
  }
}

/// A test that waited for a drive that is switched off would drive off when nobody expects it any more.
TEST(BrakingTest, WithoutADriveItIsEndedAndWaitsForNone) {
  auto v = test::corridor_vehicle();
  v->drive_silent = true;
  BrakingTest braking({0.5, 1});
  v->on_step = [&](const auto& input, const auto& /*output*/, const auto& state) {
    for (const auto& word : braking.after_step(input, state, v->config)) v->commands.push_back(word);
  };
  EXPECT_TRUE(v->run_until([&] { return braking.ended(); }, 3.0));
  EXPECT_FALSE(braking.trouble().empty());
  v->drive_silent = false;
  v->run_until([] { return false; }, 5.0);
  EXPECT_NEAR(v->rolling.speed().linear_mps, 0.0, 0.001);
}

TEST(BrakingVerdict, WhatAnEmptyVehicleCanTheLoadedOneNeedNotBeAbleTo) {
  const mapping::VehicleRecord record;  // 0.8 m/s2
  const BrakingSite site{1.0, 3.0, 0.1, 0.0, record.max_deceleration_mps2, record.reaction_s};
  const std::vector<BrakingStop> better{{false, {1.0, 1.2, 0.05, 0.0}}}, worse{{false, {1.0, 0.5, 0.6, 0.0}}};
  // The panel takes the verdict over as it is.
  EXPECT_DOUBLE_EQ(verdict_of(better, site)->deceleration_mps2, record.max_deceleration_mps2);
  EXPECT_DOUBLE_EQ(verdict_of(better, site)->reaction_s, record.reaction_s);
  planning::BrakingModel of_record;
  of_record.deceleration_mps2 = record.max_deceleration_mps2;
  of_record.reaction_s = record.reaction_s;
  of_record.scan_period_s = site.scan_period_s;
  EXPECT_DOUBLE_EQ(verdict_of(better, site)->needs_m, of_record.horizon_m(site.top_speed_mps));
  const auto kept = with_measured(record, *verdict_of(better, site), false);
  EXPECT_DOUBLE_EQ(kept.max_deceleration_mps2, record.max_deceleration_mps2);
  EXPECT_DOUBLE_EQ(kept.reaction_s, record.reaction_s);
  const auto lowered = with_measured(record, *verdict_of(worse, site), true);
  EXPECT_DOUBLE_EQ(lowered.max_deceleration_mps2, 0.5);
  EXPECT_DOUBLE_EQ(lowered.reaction_s, 0.62);
}

TEST(BrakingVerdict, TheWorstStopCountsAndATopSpeedThatOutrunsTheLidarIsRefused) {
  const std::vector<BrakingStop> stops{{false, {1.0, 0.84, 0.20, 0.0}}, {true, {1.0, 0.618, 0.312, 0.0}}};
  const mapping::VehicleRecord record;  // 1 m/s
  const auto good = verdict_of(stops, BrakingSite{1.0, 3.0, 0.1, 0.0});
  ASSERT_TRUE(good);
  EXPECT_DOUBLE_EQ(good->deceleration_mps2, 0.61);
  EXPECT_DOUBLE_EQ(good->reaction_s, 0.34);
  EXPECT_NEAR(good->needs_m, 0.44 + 1.0 / 1.22, 1e-9);
  EXPECT_FALSE(outruns(*good, record.max_speed_mps));
  EXPECT_DOUBLE_EQ(with_measured(record, *good, false).max_deceleration_mps2, 0.61);
  EXPECT_DOUBLE_EQ(with_measured(record, *good, false).max_speed_mps, 1.0);

  const auto fast = verdict_of(stops, BrakingSite{1.0, 0.8, 0.1, 0.0});
  ASSERT_TRUE(fast);
  EXPECT_TRUE(outruns(*fast, record.max_speed_mps));
  EXPECT_THROW((void)with_measured(record, *fast, false), Error);
  const auto slower = with_measured(record, *fast, true);
  EXPECT_LT(slower.max_speed_mps, 1.0);
  EXPECT_LE(verdict_of(stops, BrakingSite{slower.max_speed_mps, 0.8, 0.1, 0.0})->needs_m, 0.8);
  EXPECT_FALSE(verdict_of({}, BrakingSite{}));
}

}  // namespace
}  // namespace madori::app
