#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "planning/route_graph/route_csv.hpp"
#include "tests/support/toy_vehicle.hpp"

namespace madori::app {
namespace {

/// A status every 10 ms by the controller's clock, taken in by steps that come up to 70 ms late, as on a busy
/// computer: the wheels' readings keep the controller's times.
TEST(WheelTimes, StepsThatComeLateDoNotMakeTheReadingsLate) {
  const CycleConfig config =
      test::toy_config(planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,0,0\n1,9,0\n").graph);
  const test::RollingVehicle rolling(Transform2<Map, Base>(0.0, 0.0, 0.0));
  CycleState state(config, std::make_unique<test::TruePose>(rolling));
  constexpr std::array kLate_ms{0, 30, 70, 0, 50, 20};
  constexpr std::int64_t kOffset_ms = 5'000;  // the controller was switched on so long after the epoch
  std::int64_t device_ms = 0;
  for (int i = 0; i < 60; ++i) {
    CycleInput input;
    const std::int64_t due_ms = kOffset_ms + 20 * i;
    const std::int64_t now_ms = due_ms + kLate_ms[static_cast<std::size_t>(i) % kLate_ms.size()];
    input.now = Stamp(std::chrono::milliseconds(now_ms));
    for (; kOffset_ms + device_ms <= due_ms; device_ms += 10) {
      control::wire::Status status;
      status.time_us = static_cast<std::uint32_t>(1000 * device_ms);
      input.drive.push_back(status);
    }
    state = step(std::move(state), input, config).state;
    const Stamp due{std::chrono::milliseconds(due_ms)};
    EXPECT_NEAR(to_seconds(state.track.back().stamp - due), 0.0, 1e-4) << "step " << i;
  }
}

/// A status of the controller's clock at `device_ms`, taken in at `now_ms`.
CycleInput status_at(std::int64_t device_ms, std::int64_t now_ms) {
  CycleInput input;
  input.now = Stamp(std::chrono::milliseconds(now_ms));
  control::wire::Status status;
  status.time_us = static_cast<std::uint32_t>(1000 * device_ms);
  input.drive.push_back(status);
  return input;
}

/// The computer stood still for 5 s: of what the drive said meanwhile the port kept the beginning alone, and
/// it comes at once. That is no loss of power; a clock that begins anew is, also where 32 bits cannot tell it
/// from one that ran ahead.
TEST(WheelTimes, ABacklogIsNoLossOfPowerButAClockThatBeginsAnewIs) {
  const CycleConfig config =
      test::toy_config(planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,0,0\n1,9,0\n").graph);
  const test::RollingVehicle rolling(Transform2<Map, Base>(0.0, 0.0, 0.0));
  for (const std::int64_t up_ms : {4'000, 600'000, 2'400'000}) {  // in 2,400 s the clock passes 2^31 us
    CycleState state(config, std::make_unique<test::TruePose>(rolling));
    std::int64_t now_ms = 50'000'000;
    for (int i = 0; i < 50; ++i)
      state = step(std::move(state), status_at(up_ms + 20 * i, now_ms += 20), config).state;
    CycleInput backlog = status_at(up_ms + 1'000, now_ms += 5'000);
    for (std::int64_t i = 1; i < 400; ++i)
      backlog.drive.push_back(status_at(up_ms + 1'000 + 10 * i, now_ms).drive.front());
    state = step(std::move(state), backlog, config).state;
    state = step(std::move(state), status_at(up_ms + 6'000, now_ms += 20), config).state;
    EXPECT_NE(state.mode, Mode::EmergencyStop) << up_ms;
    state = step(std::move(state), status_at(500, now_ms += 1'000), config).state;
    EXPECT_EQ(state.mode, Mode::EmergencyStop) << up_ms;
    EXPECT_EQ(state.standstill.cause.code, "emergency-stop-over") << "nobody has pressed it";
  }
}

/// The controller's clock stands: the same frame again and again, or new ones from a controller whose sensing
/// hangs. The wheels may do anything meanwhile.
TEST(WheelTimes, ADriveThatMeasuresNoMoreIsSilent) {
  const CycleConfig config =
      test::toy_config(planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,0,0\n1,9,0\n").graph);
  const test::RollingVehicle rolling(Transform2<Map, Base>(0.0, 0.0, 0.0));
  for (const bool counts_on : {false, true}) {
    CycleState state(config, std::make_unique<test::TruePose>(rolling));
    std::uint16_t sequence = 0;
    for (int i = 0; i < 75; ++i) {
      CycleInput input = status_at(20 * std::min(i, 25), 50'000'000 + 20 * i);
      sequence = static_cast<std::uint16_t>(sequence + (i <= 25 ? 2 : counts_on ? 1 : 0));
      input.drive.front().sequence = sequence;
      state = step(std::move(state), input, config).state;
      EXPECT_FALSE(i == 25 && state.standstill.cause.code == "drive-silent");
    }
    EXPECT_EQ(state.standstill.cause.code, "drive-silent") << counts_on;
  }
}

/// The wheels at 1 m/s, read at `device_ms`.
control::wire::Status rolled(std::int64_t device_ms, double wheel_radius_m) {
  const double turns = 1e-3 * static_cast<double>(device_ms) / wheel_radius_m / (2.0 * kPi);
  control::wire::Status status;
  status.sequence = static_cast<std::uint16_t>(device_ms / 10 + 1);
  status.time_us = static_cast<std::uint32_t>(1000 * device_ms);
  status.left_turns = status.right_turns = static_cast<std::int16_t>(std::floor(turns));
  status.left_angle = status.right_angle =
      static_cast<std::uint16_t>((turns - std::floor(turns)) * control::wire::kCountsPerTurn);
  return status;
}

/// On a computer that stood still for a moment a revolution comes late, after wheels that have gone on: what
/// it saw stands where it was seen, or is left out where nobody knows any more where that was.
TEST(WheelTimes, WhatALateRevolutionSawStandsWhereItWasSeen) {
  const CycleConfig config =
      test::toy_config(planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,0,0\n1,9,0\n").graph);
  constexpr std::int64_t kTaken_ms = 4'000;
  constexpr std::int64_t kEpoch_ms = 1'000'000;
  constexpr double kBodyM = 7.0;  // ahead of where the vehicle began, which is at 4 m when it looks
  for (const std::int64_t late_ms : {0, 400, 1'500, 2'600, 6'000}) {
    const test::RollingVehicle rolling(Transform2<Map, Base>(0.0, 0.0, 0.0));
    CycleState state(config, std::make_unique<test::TruePose>(rolling));
    for (std::int64_t ms = 0; ms <= kTaken_ms + late_ms; ms += 10) {
      CycleInput input;
      input.now = Stamp(std::chrono::milliseconds(kEpoch_ms + ms));
      input.drive.push_back(rolled(ms, config.odometry.wheels.left_radius_m));
      if (ms == kTaken_ms + late_ms) {
        PointCloud<Lidar> cloud{Stamp(std::chrono::milliseconds(kEpoch_ms + kTaken_ms)), {}};
        for (int row = 0; row < 4; ++row)
          for (int column = 0; column < 5; ++column)
            cloud.points.push_back({.x_m = static_cast<float>(kBodyM - 4.0),
                                    .y_m = 0.02F * static_cast<float>(column),
                                    .z_m = -0.4F - 0.02F * static_cast<float>(row)});
        input.clouds.push_back(cloud);
      }
      state = step(std::move(state), input, config).state;
    }
    const auto& columns = state.obstacles.columns();
    if (late_ms == 6'000) {
      EXPECT_TRUE(columns.empty());
      continue;
    }
    ASSERT_FALSE(columns.empty()) << late_ms;
    for (const auto& column : columns) EXPECT_NEAR(column.centre().x_m, kBodyM, 0.02) << late_ms;
  }
}

}  // namespace
}  // namespace madori::app
