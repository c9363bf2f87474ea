#include "simulation/factory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/receiver.hpp"
#include "tests/support/small_hall.hpp"

namespace madori::simulation {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using test::Receiver;
namespace wire = control::wire;

/// The PC's half of the drive link.
class Commander {
 public:
  explicit Commander(Factory& factory) : factory_(factory) {}
  void send(bool enable, double left_radps, double right_radps) {
    wire::Command command;
    command.sequence = ++sequence_;
    command.enable = enable;
    command.left_uradps = static_cast<std::int32_t>(left_radps * 1e6);
    command.right_uradps = static_cast<std::int32_t>(right_radps * 1e6);
    std::array<std::uint8_t, wire::kMaxFrame> frame{};
    const std::size_t size = wire::encode(command, frame.data());
    factory_.drive_write({frame.data(), size});
  }

 private:
  Factory& factory_;
  std::uint16_t sequence_ = 0;
};

std::vector<std::uint8_t> all_bytes(const FactorySetup& setup, milliseconds step) {
  Factory factory(setup);
  std::vector<std::uint8_t> bytes;
  for (milliseconds t{0}; t < milliseconds(600); t += step) {
    factory.step(step, {3.0, 4.0});
    for (const auto& p : factory.take_packets()) bytes.insert(bytes.end(), p.bytes.begin(), p.bytes.end());
  }
  return bytes;
}

TEST(Factory, TheSameSeedGivesTheSameBytesWhateverTheStep) {
  FactorySetup setup = test::small_hall();
  setup.scenario.vlp16 = {};
  setup.scenario.lms1xx = {};
  setup.scenario.s300 = {};
  setup.scenario.vehicle = {};
  MoverSpec person;
  person.path = {{8.0, 2.0}, {8.0, 9.0}};
  setup.scenario.movers = {person};
  const auto first = all_bytes(setup, milliseconds(10));
  EXPECT_GT(first.size(), 400'000U);
  EXPECT_EQ(first, all_bytes(setup, milliseconds(10)));
  EXPECT_EQ(first, all_bytes(setup, milliseconds(30)));
  setup.seed = 2;
  EXPECT_NE(first, all_bytes(setup, milliseconds(10)));
}

TEST(Factory, ScannersSeeTheWallsWhereTheyAre) {
  Factory factory(test::small_hall());
  Receiver receiver({});
  factory.step(seconds(1));
  receiver.push(factory.take_packets());
  ASSERT_GT(receiver.lms_scans.size(), 45U);
  ASSERT_GT(receiver.s300_scans.size(), 22U);
  const auto front = *factory.mounting(Device::Lms1xx), safety = *factory.mounting(Device::S300);
  const LaserScan& lms = receiver.lms_scans.back();
  ASSERT_EQ(lms.ranges_m.size(), 541U);
  EXPECT_NEAR(lms.ranges_m[270], 20.0 - 5.0 - front.x_m, 0.001);
  EXPECT_NEAR(lms.ranges_m[90], 4.0, 0.001);
  EXPECT_NEAR(lms.ranges_m[450], 8.0, 0.001);
  EXPECT_NEAR(receiver.s300_scans.back().ranges_m[270], 20.0 - 5.0 - safety.x_m, 0.006);
  EXPECT_NEAR(to_seconds(lms.stamp - factory.now()), -0.035, 0.02);
}

TEST(Factory, VelodyneCloudLiesOnWallsFloorAndCeiling) {
  Factory factory(test::small_hall());
  Receiver receiver({});
  factory.step(seconds(1));
  receiver.push(factory.take_packets());
  ASSERT_GE(receiver.clouds.size(), 9U);
  const auto& points = receiver.clouds[3].points;
  EXPECT_NEAR(static_cast<double>(points.size()), 28'935.0, 400.0);
  const auto top = *factory.mounting(Device::Vlp16);
  for (const CloudPoint& p : points) {
    const double x = p.x_m + top.x_m + 5.0, y = p.y_m + 4.0, z = p.z_m + top.z_m;
    const double off = std::min(
        {std::abs(x), std::abs(x - 20.0), std::abs(y), std::abs(y - 12.0), std::abs(z), std::abs(z - 6.0)});
    // 1 mm of rounding and 0.005 deg of azimuth.
    ASSERT_LT(off, 0.004) << x << ' ' << y << ' ' << z;
  }
}

TEST(Factory, EachFiringLeavesFromWhereTheVehicleIsAtItsTime) {
  FactorySetup setup = test::small_hall(20.0, 12.0, 3.0, 6.0);
  setup.scenario.vehicle.motor_lag_s = 0.0;
  setup.scenario.vehicle.acceleration_mps2 = 50.0;
  Factory factory(setup);
  Receiver receiver({});
  factory.step(seconds(2), {20.0, 20.0});  // 2 m/s
  receiver.push(factory.take_packets());
  const auto& cloud = receiver.clouds.at(15);
  const double start_s = to_seconds(cloud.stamp - setup.epoch);
  const double top_x = factory.mounting(Device::Vlp16)->x_m;
  int checked = 0;
  for (const CloudPoint& p : cloud.points) {
    const double base_x = 3.0 + 2.0 * (start_s + p.time_offset_s) - 0.04;  // less the start: 2 m/s at 50 m/s2
    if (p.ring != 7 && p.ring != 8) continue;
    if (std::abs(p.y_m) > 1.0 || p.x_m < 0.0F) continue;
    EXPECT_NEAR(base_x + top_x + p.x_m, 20.0, 0.01);
    ++checked;
  }
  EXPECT_GT(checked, 50);
}

TEST(Factory, AVehicleAsRecordedNeedsTheWayToStandThatItsRecordPromises) {
  for (const double deceleration : {0.5, 1.5})
    for (const double reaction_s : {0.05, 0.4}) {
      FactorySetup setup = test::small_hall(20.0, 12.0, 3.0, 6.0);
      setup.vehicle.max_deceleration_mps2 = deceleration;
      setup.vehicle.reaction_s = reaction_s;
      setup.scenario.vehicle.as_recorded = true;
      Factory factory(setup);
      factory.step(seconds(4), {10.0, 10.0});  // 1 m/s
      const double before_m = factory.distance_driven_m();
      factory.step(seconds(5), {0.0, 0.0});
      const double promised_m = reaction_s + 1.0 / (2.0 * deceleration);
      EXPECT_LE(factory.distance_driven_m() - before_m, promised_m + 0.005)
          << deceleration << ' ' << reaction_s;
      EXPECT_GT(factory.distance_driven_m() - before_m, promised_m - 0.06)
          << deceleration << ' ' << reaction_s;
    }
}

TEST(Factory, GlassLetsBeamsThroughUnlessTheyAreSquareOnIt) {
  FactorySetup setup = test::small_hall();
  setup.scenario.glass = {{{{12.0, 0.0}, {12.0, 12.0}}, 0.0, 5.0}};
  Factory factory(setup);
  Receiver receiver({});
  factory.step(seconds(1));
  receiver.push(factory.take_packets());
  const auto front = *factory.mounting(Device::Lms1xx);
  const LaserScan& scan = receiver.lms_scans.back();
  EXPECT_NEAR(scan.ranges_m[270], 12.0 - 5.0 - front.x_m, 0.001);
  int beyond = 0, lost = 0, on_glass = 0;
  for (std::size_t i = 230; i <= 310; ++i) {
    const double at = 5.0 + front.x_m + scan.ranges_m[i] * std::cos(scan.angle_rad(i));
    if (!std::isfinite(scan.ranges_m[i]))
      ++lost;
    else if (std::abs(at - 12.0) < 0.01)
      ++on_glass;
    else if (at > 12.01)
      ++beyond;
  }
  EXPECT_GE(on_glass, 39);
  EXPECT_GE(beyond, 30);
  EXPECT_GE(lost, 1);
  EXPECT_LE(lost, 10);
}

TEST(Factory, DualReturnCarriesBothSidesOfThePane) {
  FactorySetup setup = test::small_hall();
  setup.scenario.glass = {{{{12.0, 0.0}, {12.0, 12.0}}, 0.0, 5.0}};
  setup.scenario.vlp16.dual_return = true;
  Factory factory(setup);
  factory.step(seconds(1));
  int both = 0, packets = 0;
  for (const auto& p : factory.take_packets()) {
    if (p.device != Device::Vlp16) continue;
    sensors::vlp16::DataPacket packet;
    ASSERT_EQ(sensors::vlp16::decode(p.bytes, packet), sensors::vlp16::PacketFault::None);
    ASSERT_EQ(packet.mode, sensors::vlp16::ReturnMode::Dual);
    ++packets;
    for (std::size_t b = 0; b < sensors::vlp16::kBlocks; b += 2) {
      EXPECT_EQ(packet.blocks[b].azimuth_cdeg, packet.blocks[b + 1].azimuth_cdeg);
      for (std::size_t i = 0; i < sensors::vlp16::kReturns; ++i)
        both += packet.blocks[b].returns[i].distance > packet.blocks[b + 1].returns[i].distance ? 1 : 0;
    }
  }
  EXPECT_NEAR(packets, 1507, 2);
  EXPECT_GT(both, 500);
}

TEST(Factory, TheDriveObeysItsLinkAndStopsAfter200msOfSilence) {
  Factory factory(test::small_hall(40.0, 12.0));
  Commander pc(factory);
  pc.send(false, 0.0, 0.0);
  for (int i = 0; i < 200; ++i) {
    pc.send(true, 5.0, 5.0);
    factory.step(milliseconds(10));
  }
  EXPECT_EQ(factory.drive_state(), wire::DriveState::Running);
  EXPECT_NEAR(factory.truth().linear_mps, 0.5, 1e-3);
  factory.step(milliseconds(185));
  EXPECT_EQ(factory.drive_state(), wire::DriveState::Running);
  factory.step(milliseconds(10));
  EXPECT_EQ(factory.drive_state(), wire::DriveState::WatchdogStop);
  factory.step(milliseconds(600));
  EXPECT_NEAR(factory.truth().linear_mps, 0.0, 1e-3);
}

TEST(Factory, OdometryFollowsTheVehicleWithinItsEncoders) {
  Factory factory(test::small_hall(40.0, 30.0, 10.0, 10.0));
  Receiver receiver({});
  for (int i = 0; i < 1000; ++i) {
    factory.step(milliseconds(10), {4.0, 5.0});
    receiver.push(factory.take_packets());
  }
  const auto truth = factory.truth().map_from_base;
  const auto start = Transform2<Map, Odom>(10.0, 4.0 + 6.0, 0.0);
  const auto dead_reckoning = start * receiver.latest_odometry().odom_from_base;
  EXPECT_LT(distance_m(truth.translation(), dead_reckoning.translation()), 0.005);
  EXPECT_NEAR(wrap_angle(truth.yaw_rad() - dead_reckoning.yaw_rad()), 0.0, 0.003);
}

TEST(Factory, ALoadMakesTheVehicleSlowerToStart) {
  FactorySetup light = test::small_hall(40.0, 12.0), heavy = light;
  heavy.scenario.vehicle.load_kg = 300.0;
  Factory a(light), b(heavy);
  a.step(milliseconds(300), {10.0, 10.0});
  b.step(milliseconds(300), {10.0, 10.0});
  EXPECT_NEAR(b.truth().linear_mps / a.truth().linear_mps, 1.0 / 3.0, 0.02);
}

TEST(Factory, TheDrawingMayBeWrong) {
  FactorySetup setup = test::small_hall();
  setup.scenario.building.scale_error_x_percent = 1.0;
  setup.scenario.building.scale_error_y_percent = -0.5;
  setup.scenario.building.missing_walls = {3};
  setup.scenario.building.moved_walls = {{{1}, 0.0, -0.3}};
  setup.scenario.building.added_walls = {{{10.0, 0.0}, {10.0, 2.0}}};
  Factory factory(setup);
  EXPECT_EQ(factory.world().walls().size(), 4U);
  EXPECT_NEAR(factory.world().walls()[0].a.y_m, -0.3 * 0.995, 1e-9);
  EXPECT_NEAR(factory.world().walls()[1].a.x_m, 20.2, 1e-9);
  const GroundTruth truth = factory.truth();
  EXPECT_NEAR(truth.map_from_base.x_m(), 5.0, 1e-9);
  EXPECT_NEAR(truth.building_from_base.x_m(), 5.05, 1e-9);
  EXPECT_NEAR(truth.building_from_base.y_m(), 3.98, 1e-9);
}

TEST(Factory, ARampLiftsAndTiltsTheSensors) {
  FactorySetup setup = test::small_hall(24.0, 12.0, 10.0, 6.0);
  setup.scenario.ramps = {{{10.5, 6.0}, 0.0, 6.0, 4.0, 0.6}};
  Factory factory(setup);
  Receiver receiver({});
  factory.step(milliseconds(300));
  receiver.push(factory.take_packets());
  const double slope = std::atan(0.1);
  EXPECT_NEAR(factory.world().floor_at({10.0, 6.0}).z_m, 0.25, 1e-9);
  const auto front = *factory.mounting(Device::Lms1xx);
  const double x = 10.0 + front.x_m * std::cos(slope) - front.z_m * std::sin(slope);
  const LaserScan& scan = receiver.lms_scans.back();
  EXPECT_NEAR(scan.ranges_m[270], (24.0 - x) / std::cos(slope), 0.002) << "climbs to the far wall";
  EXPECT_NEAR(scan.ranges_m[450], 6.0, 0.002) << "straight aside it stays level";
}

}  // namespace
}  // namespace madori::simulation
