// Every fault that a scenario can ask for, seen from the PC's side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/receiver.hpp"
#include "tests/support/small_hall.hpp"

namespace madori::simulation {
namespace {

using std::chrono::milliseconds;
using test::Receiver;

FaultSpec fault(FaultKind kind, Device device, double at_s = 0.0, double for_s = 100.0) {
  FaultSpec f;
  f.kind = kind;
  f.device = device;
  f.at_s = at_s;
  f.for_s = for_s;
  return f;
}

struct Seen {
  Factory factory;
  Receiver receiver;
  std::vector<DevicePacket> packets;

  explicit Seen(const FactorySetup& setup) : factory(setup), receiver({}) {}
  void run(double duration_s, const WheelCommand& wheels = {}) {
    for (int i = 0; i < std::lround(duration_s * 100.0); ++i) {
      factory.step(milliseconds(10), wheels);
      const auto arrived = factory.take_packets();
      receiver.push(arrived);
      packets.insert(packets.end(), arrived.begin(), arrived.end());
    }
  }
  [[nodiscard]] std::size_t count(Device device) const {
    return static_cast<std::size_t>(
        std::count_if(packets.begin(), packets.end(), [&](const auto& p) { return p.device == device; }));
  }
};

FactorySetup with(const FaultSpec& f) {
  FactorySetup setup = test::small_hall();
  setup.scenario.faults = {f};
  return setup;
}

constexpr std::array kAll{Device::Vlp16, Device::Lms1xx, Device::S300, Device::Drive};

TEST(Fault, SilenceStopsOneDeviceForItsTime) {
  for (const Device device : kAll) {
    Seen quiet(with(fault(FaultKind::Silence, device, 0.2, 0.2))), whole(test::small_hall());
    quiet.run(0.6), whole.run(0.6);
    const double share = static_cast<double>(quiet.count(device)) / static_cast<double>(whole.count(device));
    EXPECT_NEAR(share, 2.0 / 3.0, 0.05) << to_string(device);
    for (const Device other : kAll)
      if (other != device) {
        EXPECT_EQ(quiet.count(other), whole.count(other));
      }
  }
}

TEST(Fault, SilenceOfTheDriveCutsCommandsToo) {
  Factory factory(with(fault(FaultKind::Silence, Device::Drive, 0.5)));
  namespace wire = control::wire;
  for (std::uint16_t i = 1; i < 100; ++i) {
    std::array<std::uint8_t, wire::kMaxFrame> frame{};
    const std::size_t size = wire::encode(wire::Command{i, i > 1, 5'000'000, 5'000'000}, frame.data());
    factory.drive_write({frame.data(), size});
    factory.step(milliseconds(10));
    if (i == 45) {
      EXPECT_EQ(factory.drive_state(), wire::DriveState::Running);
    }
  }
  EXPECT_EQ(factory.drive_state(), wire::DriveState::WatchdogStop);
}

TEST(Fault, DropLosesAShare) {
  FaultSpec f = fault(FaultKind::Drop, Device::Vlp16);
  f.share = 0.25;
  Seen seen(with(f)), whole(test::small_hall());
  seen.run(1.0), whole.run(1.0);
  EXPECT_NEAR(
      static_cast<double>(seen.count(Device::Vlp16)) / static_cast<double>(whole.count(Device::Vlp16)), 0.75,
      0.06);
  EXPECT_GT(seen.receiver.vlp16().counters().lost, 100U);
}

TEST(Fault, CorruptChangesExactlyOneByte) {
  for (const Device device : kAll) {
    Seen bad(with(fault(FaultKind::Corrupt, device))), good(test::small_hall());
    bad.run(0.2), good.run(0.2);
    ASSERT_EQ(bad.packets.size(), good.packets.size());
    for (std::size_t i = 0; i < good.packets.size(); ++i) {
      int changed = 0;
      for (std::size_t k = 0; k < good.packets[i].bytes.size(); ++k)
        changed += good.packets[i].bytes[k] != bad.packets[i].bytes[k] ? 1 : 0;
      EXPECT_EQ(changed, good.packets[i].device == device ? 1 : 0);
    }
  }
}

TEST(Fault, AWrongChecksumIsThrownAwayByTheDecoder) {
  Seen lms(with(fault(FaultKind::Checksum, Device::Lms1xx)));
  lms.run(0.4);
  EXPECT_TRUE(lms.receiver.lms_scans.empty());
  EXPECT_GT(lms.receiver.lms1xx().damaged(), 10U);
  Seen s300(with(fault(FaultKind::Checksum, Device::S300)));
  s300.run(0.4);
  EXPECT_TRUE(s300.receiver.s300_scans.empty());
  EXPECT_GT(s300.receiver.s300().counters().damaged, 5U);
  Seen drive(with(fault(FaultKind::Checksum, Device::Drive)));
  drive.run(0.4);
  EXPECT_FALSE(drive.receiver.drive_status());
  EXPECT_EQ(drive.receiver.damaged_status_frames(), 40U);
}

TEST(Fault, DelayHoldsPacketsBackWithoutLosingThem) {
  FaultSpec f = fault(FaultKind::Delay, Device::Lms1xx, 0.2, 0.2);
  f.delay_s = 0.1;
  Seen late(with(f)), whole(test::small_hall());
  late.run(0.6), whole.run(0.6);
  EXPECT_EQ(late.count(Device::Lms1xx), whole.count(Device::Lms1xx));
  const auto arrivals = [](const Seen& seen) {
    std::vector<double> times;
    for (const auto& p : seen.packets)
      if (p.device == Device::Lms1xx)
        times.push_back(to_seconds(p.sent.time_since_epoch() - std::chrono::seconds(1'767'225'600)));
    return times;
  };
  double most = 0.0;
  const auto a = arrivals(late), b = arrivals(whole);
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, a[i] - b[i]);
  EXPECT_NEAR(most, 0.1, 0.025);
}

TEST(Fault, DuplicatesAreCountedByTheDecoder) {
  Seen seen(with(fault(FaultKind::Duplicate, Device::Vlp16)));
  seen.run(0.5);
  EXPECT_EQ(seen.receiver.vlp16().counters().duplicates, seen.receiver.vlp16().counters().packets);
}

TEST(Fault, StandbyOfTheS300MustStopTheVehicle) {
  Seen seen(with(fault(FaultKind::Standby, Device::S300)));
  seen.run(0.2);
  ASSERT_TRUE(seen.receiver.fields());
  EXPECT_TRUE(seen.receiver.fields()->standby);
  EXPECT_TRUE(seen.receiver.fields()->must_stop());
}

TEST(Fault, AStuckEncoderKeepsItsAngleWhileTheWheelTurns) {
  FaultSpec f = fault(FaultKind::StuckEncoder, Device::Drive, 1.0);
  f.wheel = Wheel::Left;
  Seen seen(with(f));
  seen.run(0.98, {5.0, 5.0});
  seen.run(0.1, {5.0, 5.0});
  const auto before = *seen.receiver.drive_status();
  seen.run(0.5, {5.0, 5.0});
  const auto after = *seen.receiver.drive_status();
  EXPECT_EQ(before.left_angle, after.left_angle);
  EXPECT_NE(before.right_angle, after.right_angle);
  EXPECT_NEAR(seen.factory.truth().linear_mps, 0.5, 0.01);
}

TEST(Fault, ASlippingWheelTurnsTheVehicle) {
  FaultSpec f = fault(FaultKind::Slip, Device::Drive);
  f.wheel = Wheel::Right;
  f.share = 0.3;
  Seen seen(with(f));
  seen.run(2.0, {5.0, 5.0});
  const auto reading = seen.receiver.latest_odometry().odom_from_base;
  EXPECT_NEAR(reading.yaw_rad(), 0.0, 0.002) << "the encoders see none of it";
  const double turned = seen.factory.truth().map_from_base.yaw_rad();
  EXPECT_NEAR(turned, -0.3 * seen.factory.vehicle_state().right_rad * 0.1 / 0.5, 1e-3);
}

TEST(Fault, EmergencyStopAndDriveFaultHoldTheDrive) {
  Seen stop(with(fault(FaultKind::EmergencyStop, Device::Drive, 0.1, 0.1)));
  stop.run(0.15);
  EXPECT_EQ(stop.receiver.drive_status()->state, control::wire::DriveState::EmergencyStop);
  stop.run(0.2);
  EXPECT_EQ(stop.receiver.drive_status()->state, control::wire::DriveState::EmergencyStop)
      << "told on for 0.2 s";
  stop.run(0.1);
  EXPECT_EQ(stop.receiver.drive_status()->state, control::wire::DriveState::Idle);
  Seen broken(with(fault(FaultKind::DriveFault, Device::Drive)));
  broken.run(0.1);
  EXPECT_EQ(broken.receiver.drive_status()->state, control::wire::DriveState::Fault);
}

TEST(Fault, KidnappingMovesTheVehicleOnceAndUnnoticedByItsEncoders) {
  FaultSpec f = fault(FaultKind::Kidnap, Device::Vlp16, 0.5);
  f.pose = {12.0, 9.0, 1.0};
  Seen seen(with(f));
  seen.run(0.49, {5.0, 5.0});
  const double before = seen.receiver.latest_odometry().odom_from_base.x_m();
  EXPECT_LT(seen.factory.truth().map_from_base.x_m(), 5.5);
  seen.run(0.02, {0.0, 0.0});
  const auto after = seen.factory.truth().map_from_base;
  EXPECT_NEAR(after.x_m(), 12.0, 0.01);
  EXPECT_NEAR(after.y_m(), 9.0, 0.01);
  EXPECT_NEAR(after.yaw_rad(), 1.0, 0.01);
  EXPECT_NEAR(seen.receiver.latest_odometry().odom_from_base.x_m(), before, 0.02);
  seen.run(0.5, {5.0, 5.0});
  EXPECT_GT(distance_m(seen.factory.truth().map_from_base.translation(), {12.0, 9.0}), 0.1);
}

TEST(Fault, MayBeInjectedWhileRunning) {
  Seen seen(test::small_hall());
  seen.run(0.2);
  seen.factory.inject(fault(FaultKind::EmergencyStop, Device::Drive, 0.1, 0.1));
  seen.run(0.05);
  EXPECT_EQ(seen.receiver.drive_status()->state, control::wire::DriveState::Idle);
  seen.run(0.1);
  EXPECT_EQ(seen.receiver.drive_status()->state, control::wire::DriveState::EmergencyStop);
}

TEST(ProtectiveField, IsViolatedByWhatStandsCloseAheadOnly) {
  for (const double x : {6.2, 7.2, 9.5}) {
    FactorySetup setup = test::small_hall();
    MoverSpec person;
    person.path = {{x, 4.0}};
    setup.scenario.movers = {person};
    Seen seen(setup);
    seen.run(0.2);
    ASSERT_TRUE(seen.receiver.fields());
    EXPECT_EQ(seen.receiver.fields()->protective, x < 6.5);
    EXPECT_EQ(seen.receiver.fields()->warning, x < 8.0);
  }
}

}  // namespace
}  // namespace madori::simulation
