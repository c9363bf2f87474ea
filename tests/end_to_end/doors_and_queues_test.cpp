// Places where a vehicle waits for others, in the sample factory: its lidar's bytes, its real localization,
// the whole cycle in lock-step. Nothing may be touched, by anybody, and each order is carried out without a
// person's help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/lock_step_run.hpp"

namespace madori {
namespace {

using simulation::DoorSpec;
using simulation::MoverKind;
using simulation::MoverSpec;
using simulation::Plan;
using simulation::SolidSpec;

constexpr int kBehindDoor = 11, kLift = 19, kBay = 20, kBay2 = 21, kBatteries = 26;

/// The vehicle at a place of the factory frame, nobody about.
struct Scene {
  Scene(double x_m, double y_m, double yaw_deg)
      : site(app::load_for_driving(MADORI_SAMPLE_SITE)),
        setup(simulation::load_setup(MADORI_SAMPLE_SITE, MADORI_SAMPLE_SITE "/scenario.yaml")) {
    setup.scenario.movers.clear();
    setup.scenario.vlp16.keep_every_firing = 3;
    setup.scenario.start = {x_m, y_m, to_rad(yaw_deg)};
  }
  [[nodiscard]] DoorSpec& door(const std::string& name) {
    return *std::ranges::find(setup.scenario.doors, name, &DoorSpec::name);
  }
  void limit_speed(double mps) {
    auto& c = site.config;
    c.pursuit.speed.max_speed_mps = c.limits.max_speed_mps = c.movers.top_speed_mps = mps;
  }
  void add_solid(Point2<Plan> centre, double length_m, double width_m) {
    SolidSpec solid;
    solid.centre = centre;
    solid.length_m = length_m, solid.width_m = width_m, solid.height_m = 1.2;
    setup.scenario.solids.push_back(solid);
  }

  app::SiteForDriving site;
  simulation::FactorySetup setup;
};

class Drive : public test::LockStepRun {
 public:
  explicit Drive(const Scene& scene) : LockStepRun(scene.site, scene.setup) {}

  std::int64_t order(int node) {
    return orders->add({{node, app::StopAction::Pass, 0.0}}, 1, factory->now());
  }
  [[nodiscard]] bool is_done(std::int64_t order) const {
    return orders->find(order)->state == app::OrderState::Done;
  }
  /// Whether it gets there; what it was about where it does not.
  testing::AssertionResult delivers(std::int64_t id, double limit_s) {
    if (run_until([&] { return is_done(id); }, limit_s)) return testing::AssertionSuccess();
    const auto at = factory->truth().map_from_base;
    const auto plan = factory->world().frames().map_from_plan.inverse() * at.translation();
    return testing::AssertionFailure()
           << "at (" << plan.x_m << ", " << plan.y_m << ") after " << time_s()
           << " s: " << to_string(state().mode) << ", " << state().standstill.cause.text << " - "
           << state().standstill.remedy.text;
  }
  [[nodiscard]] std::vector<std::string> touched() const {
    std::vector<std::string> all;
    for (const auto& c : factory->collisions())
      all.push_back(c.what + " at " + std::to_string(c.speed_mps) + " m/s");
    return all;
  }
  [[nodiscard]] bool waits_for(app::Cause cause) const {
    return state().mode == app::Mode::Waiting && state().standstill.cause.code == app::notice(cause).code;
  }
};

/// Its lower edge at 1.25 m of 2.5 m: above the vehicle (0.8 m), not above its lidar.
TEST(Lift, IsWaitedForWhileItsDoorIsHalfOpen) {
  Scene scene(32.4, 37.0, 90.0);
  DoorSpec& lift = scene.door("lift door");
  lift.stuck_at = 0.5;
  lift.stuck_until_s = 60.0;
  Drive drive(scene);
  const auto order = drive.order(kLift);
  EXPECT_TRUE(drive.run_until([&] { return drive.waits_for(app::Cause::DoorNotOpen); }, 40.0));
  EXPECT_TRUE(
      !drive.run_until([&] { return !drive.waits_for(app::Cause::DoorNotOpen); }, 59.0 - drive.time_s()))
      << "it stays until the door opens, and tries nothing beside it";
  EXPECT_TRUE(drive.delivers(order, 60.0));
  EXPECT_THAT(drive.touched(), testing::IsEmpty());
}

/// ... and at 1.75 m.
TEST(Lift, IsDrivenUnderWhereItsDoorIsOpenHighEnough) {
  Scene scene(32.4, 37.0, 90.0);
  DoorSpec& lift = scene.door("lift door");
  lift.stuck_at = 0.7;
  lift.stuck_until_s = 1e6;
  Drive drive(scene);
  EXPECT_TRUE(drive.delivers(drive.order(kLift), 90.0));
  EXPECT_THAT(drive.touched(), testing::IsEmpty());
}

/// A leaf that draws back only half way leaves 2 m of 4, beside the route.
TEST(Door, OneThatOpensHalfWayIsWaitedFor) {
  Scene scene(36.5, 30.0, 0.0);
  DoorSpec& door = scene.door("automatic door");
  door.stuck_at = 0.5;
  door.stuck_until_s = 60.0;
  Drive drive(scene);
  EXPECT_TRUE(drive.delivers(drive.order(kBehindDoor), 150.0));
  EXPECT_THAT(drive.touched(), testing::IsEmpty());
}

/// It opens by the clock for less time than the vehicle needs to get through.
class ClosingDoor : public testing::TestWithParam<int> {};

TEST_P(ClosingDoor, DoesNotTouchASlowVehicle) {
  Scene scene(40.0, 30.0, 0.0);
  DoorSpec& door = scene.door("automatic door");
  door.trigger_m = 0.0;
  door.period_s = 16.0;
  door.hold_s = 6.0;
  scene.limit_speed(0.3);
  Drive drive(scene);
  drive.run_until([] { return false; }, 4.0 * GetParam());
  EXPECT_TRUE(drive.delivers(drive.order(kBehindDoor), 240.0));
  EXPECT_THAT(drive.touched(), testing::IsEmpty());
}
INSTANTIATE_TEST_SUITE_P(AtAllTimes, ClosingDoor, testing::Range(0, 4));

/// Two forklifts wait one behind the other before a door that opens late, and then drive on, with stops.
TEST(Queue, OfTwoIsWaitedForAndFollowed) {
  Scene scene(35.2, 22.0, 90.0);
  scene.door("automatic door").stuck_at = 0.0;
  scene.door("automatic door").stuck_until_s = 45.0;
  const std::vector<Point2<Plan>> on{{53.6, 30.0}, {53.6, 25.0}, {66.0, 24.0}};
  for (const double x_m : {44.2, 40.7}) {
    MoverSpec forklift;
    forklift.kind = MoverKind::Forklift;
    forklift.name = x_m > 42.0 ? "first" : "second";
    forklift.path = {{x_m, 30.0}};
    forklift.path.insert(forklift.path.end(), on.begin(), on.end());
    forklift.path.back().x_m += x_m - 40.7;
    forklift.speed_mps = 0.5;
    forklift.start_s = x_m > 42.0 ? 50.0 : 56.0;
    forklift.pause_s = 1e6;
    scene.setup.scenario.movers.push_back(forklift);
  }
  Drive drive(scene);
  EXPECT_TRUE(drive.delivers(drive.order(kBay2), 240.0));
  EXPECT_THAT(drive.touched(), testing::IsEmpty());
}

/// A station at the end of a niche in which the vehicle cannot turn round: it comes out again by itself.
TEST(DeadEnd, IsLeftAgainWhereThereIsNoRoomToTurn) {
  Scene scene(53.6, 19.0, 270.0);
  for (const double side : {-1.0, 1.0}) scene.add_solid({49.2, 13.0 + side * 0.8}, 2.6, 0.5);
  Drive drive(scene);
  EXPECT_TRUE(drive.delivers(drive.order(kBay), 90.0));
  EXPECT_TRUE(drive.delivers(drive.order(kBay2), 240.0));
  EXPECT_THAT(drive.touched(), testing::IsEmpty());
}

/// An aisle that is closed across its whole width, its station beyond: said, waited for, and driven once
/// clear.
TEST(DeadEnd, OfAClosedAisleIsWaitedForAndSaid) {
  Scene scene(55.0, 25.8, 0.0);
  for (int i = 0; i < 16; ++i) {
    MoverSpec pallet;
    pallet.kind = MoverKind::Pallet;
    pallet.name = "closed";
    pallet.path = {{61.5 + 1.2 * i, 37.0}};
    scene.setup.scenario.movers.push_back(pallet);
  }
  Drive drive(scene);
  const auto order = drive.order(kBatteries);
  EXPECT_FALSE(drive.run_until([&] { return drive.is_done(order); }, 75.0));
  EXPECT_TRUE(drive.run_until([&] { return drive.waits_for(app::Cause::SomethingInTheWay); }, 60.0))
      << "between tries it stands, and says why";
  drive.factory->remove_mover("closed");
  EXPECT_TRUE(drive.delivers(order, 120.0));
  EXPECT_THAT(drive.touched(), testing::IsEmpty());
}

}  // namespace
}  // namespace madori
