#include <gtest/gtest.h>

#include "control/drive_link/controller.hpp"

namespace madori::control::wire {
namespace {

/// A controller with a PC that sends and a clock that runs.
class Bench {
 public:
  void send(bool enable, std::int32_t speed_uradps = 1'000'000) {
    send_again(Command{++sequence_, enable, speed_uradps, speed_uradps});
  }
  void send_again(const Command& command) {
    std::uint8_t frame[kMaxFrame];
    const std::size_t size = encode(command, frame);
    for (std::size_t i = 0; i < size; ++i) controller.receive(frame[i], now_us);
    last = command;
  }
  void wait_ms(std::uint32_t duration_ms) {
    for (std::uint32_t i = 0; i < duration_ms; ++i) controller.tick(inputs, now_us += 1000);
  }
  void start() {
    wait_ms(1);
    send(false);
    send(true);
  }

  Controller controller;
  ControllerInputs inputs;
  Command last;
  std::uint32_t now_us = 0xFFFFFF00U;  // the clock wraps at once

 private:
  std::uint16_t sequence_ = 0xFFFE;  // so does the number
};

TEST(DriveController, RunsOnlyAfterDisableThenEnable) {
  Bench bench;
  bench.wait_ms(1);
  EXPECT_EQ(bench.controller.state(), DriveState::Idle) << "nobody was silent yet";
  bench.send(true);
  EXPECT_EQ(bench.controller.state(), DriveState::Idle);
  EXPECT_EQ(bench.controller.left_uradps(), 0);
  bench.send(false);
  bench.send(true);
  EXPECT_EQ(bench.controller.state(), DriveState::Running);
  EXPECT_EQ(bench.controller.left_uradps(), 1'000'000);
}

TEST(DriveController, TheWheelsStandUntilTheInputsWereRead) {
  Bench bench;
  bench.send(false);
  bench.send(true);
  EXPECT_EQ(bench.controller.left_uradps(), 0) << "the emergency stop may be pressed";
  bench.wait_ms(1);
  bench.send(true);
  EXPECT_EQ(bench.controller.left_uradps(), 0) << "no command without enable has come since";
}

TEST(DriveController, StopsByItselfAfter200msOfSilence) {
  Bench bench;
  bench.start();
  bench.wait_ms(199);
  EXPECT_EQ(bench.controller.state(), DriveState::Running);
  bench.wait_ms(1);
  EXPECT_EQ(bench.controller.state(), DriveState::WatchdogStop);
  EXPECT_EQ(bench.controller.right_uradps(), 0);
  EXPECT_TRUE(bench.controller.next_status().watchdog_expired);
}

TEST(DriveController, TheSilenceEndsTheRunBetweenTwoTicksToo) {
  Bench bench;
  bench.start();
  bench.wait_ms(195);
  bench.now_us += 5000;
  bench.send(true);
  EXPECT_EQ(bench.controller.left_uradps(), 0);
}

TEST(DriveController, AStopWithoutAnyCommandMeanwhileIsHeld) {
  Bench bench;
  bench.start();
  bench.inputs.bumper = true;
  bench.wait_ms(1);
  bench.inputs.bumper = false;
  for (int i = 0; i < 30; ++i) bench.wait_ms(10), bench.send(true);
  EXPECT_EQ(bench.controller.left_uradps(), 0) << "no command without enable has come since";
}

TEST(DriveController, StaysStoppedWhenThePcComesBackWithItsOldOrder) {
  Bench bench;
  bench.start();
  bench.wait_ms(300);
  bench.send(true);
  EXPECT_EQ(bench.controller.state(), DriveState::Idle);
  bench.send(false);
  bench.send(true);
  EXPECT_EQ(bench.controller.state(), DriveState::Running);
}

TEST(DriveController, ARepeatedFrameIsNoSignOfLife) {
  Bench bench;
  bench.start();
  for (int i = 0; i < 30; ++i) bench.wait_ms(10), bench.send_again(bench.last);
  EXPECT_NE(bench.controller.state(), DriveState::Running);
}

TEST(DriveController, EveryCauseStopsAndIsHeld) {
  struct Case {
    ControllerInputs inputs;
    DriveState state;
  };
  for (const auto& [inputs, state] :
       {Case{{.emergency_stop = true}, DriveState::EmergencyStop},
        Case{{.bumper = true}, DriveState::BumperStop}, Case{{.faults = kUndervoltage}, DriveState::Fault}}) {
    Bench bench;
    bench.start();
    bench.inputs = inputs;
    bench.wait_ms(1);
    EXPECT_EQ(bench.controller.state(), state);
    EXPECT_EQ(bench.controller.left_uradps(), 0) << "before the PC says anything";
    const Status told = bench.controller.next_status();
    EXPECT_EQ(told.emergency_stop, inputs.emergency_stop);
    EXPECT_EQ(told.bumper, inputs.bumper);
    EXPECT_EQ(told.faults, inputs.faults);
    bench.send(false);
    bench.send(true);
    EXPECT_EQ(bench.controller.left_uradps(), 0);
    bench.inputs = {};
    bench.wait_ms(ToldCause::kMicroseconds / 1000 - 1);
    bench.send(true);
    EXPECT_EQ(bench.controller.state(), state)
        << "a touch of a millisecond is told so long that the PC sees it";
    EXPECT_EQ(bench.controller.left_uradps(), 0);
    bench.wait_ms(1);
    EXPECT_EQ(bench.controller.state(), DriveState::Idle);
    bench.send(false);
    bench.send(true);
    EXPECT_EQ(bench.controller.state(), DriveState::Running);
  }
}

TEST(DriveController, CountsTurnsBothWays) {
  Bench bench;
  bench.wait_ms(1);  // takes the reference
  int counts = 0;
  for (const int step : {4000, -4000}) {
    for (int i = 0; i < 20; ++i) {
      counts += step;
      bench.inputs.left_angle = static_cast<std::uint16_t>(counts & (kCountsPerTurn - 1));
      bench.inputs.right_angle = static_cast<std::uint16_t>(-counts & (kCountsPerTurn - 1));
      bench.wait_ms(1);
      const Status status = bench.controller.next_status();
      ASSERT_EQ(status.left_turns * kCountsPerTurn + status.left_angle, counts);
      ASSERT_EQ(status.right_turns * kCountsPerTurn + status.right_angle, -counts);
    }
  }
}

TEST(DriveController, CountsStopsAndTellsTheirNumber) {
  Bench bench;
  bench.start();
  for (int stop = 1; stop <= 40; ++stop) {
    (stop % 2 == 0 ? bench.inputs.emergency_stop : bench.inputs.bumper) = true;
    bench.wait_ms(1);
    bench.inputs.emergency_stop = bench.inputs.bumper = false;
    bench.wait_ms(250);
    std::uint8_t frame[kMaxFrame];
    const std::size_t size = bench.controller.status_frame(frame);
    Status status;
    ASSERT_EQ(decode(frame, size - 1, status), Verdict::Good);
    EXPECT_EQ(status.stops, stop % kStopsWrap);
    EXPECT_FALSE(status.emergency_stop || status.bumper);
  }
}

TEST(DriveController, NumbersItsStatusesAndNamesTheCommandThatItTook) {
  Bench bench;
  bench.start();
  for (std::uint16_t i = 0; i < 5; ++i) {
    bench.send(true);
    const Status status = bench.controller.next_status();
    EXPECT_EQ(status.sequence, i);
    EXPECT_EQ(status.command_sequence, bench.last.sequence);
  }
}

TEST(DriveController, CountsDamagedFrames) {
  Bench bench;
  bench.start();
  for (const std::uint8_t byte : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{0}})
    bench.controller.receive(byte, bench.now_us);
  for (int i = 0; i < 200; ++i) bench.controller.receive(7, bench.now_us);
  bench.controller.receive(0, bench.now_us);
  EXPECT_EQ(bench.controller.next_status().rejected_frames, 2);
  EXPECT_EQ(bench.controller.state(), DriveState::Running);
}

}  // namespace
}  // namespace madori::control::wire
