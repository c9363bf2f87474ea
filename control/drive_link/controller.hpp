#pragma once

#include "control/drive_link/wire.hpp"

namespace madori::control::wire {

/// What the controller itself senses.
struct ControllerInputs {
  bool emergency_stop = false;
  bool bumper = false;
  std::uint16_t faults = kNoFault;
  std::uint16_t left_angle = 0;
  std::uint16_t right_angle = 0;
  std::uint16_t battery_mv = 0;
};

/// Why the wheels are stopped: told for so long after it has ended that status frames which are lost, and a
/// PC that looks less often, cannot hide it. Unseen, the PC would take the stop for one without a cause and
/// go on.
class ToldCause {
 public:
  static constexpr std::uint32_t kMicroseconds = 200'000;

  constexpr std::uint16_t update(std::uint16_t now, std::uint32_t now_us) {
    if (now != 0)
      told_ = static_cast<std::uint16_t>(told_ | now), last_us_ = now_us;
    else if (now_us - last_us_ >= kMicroseconds)
      told_ = 0;
    return told_;
  }

 private:
  std::uint16_t told_ = 0;
  std::uint32_t last_us_ = 0;
};

/// The motor controller's side of the link: takes the PC's bytes, decides whether the wheels may turn, and
/// counts the encoders' turns. Firmware and simulator run this same class. Freestanding.
///
/// Any stop (silence, emergency stop, bumper, fault) is held: its cause is told for at least 200 ms; when it
/// has gone, the state is Idle, it is counted, and the wheels turn again only after a command without enable
/// has been followed by one with it.
class Controller {
 public:
  /// One byte from the line; `now_us` is the controller's clock, which may wrap.
  constexpr void receive(std::uint8_t byte, std::uint32_t now_us) {
    if (!cutter_.push(byte)) {
      if (cutter_.overflows() != overflows_) overflows_ = cutter_.overflows(), ++rejected_;
      return;
    }
    Command command;
    if (decode(cutter_.frame(), cutter_.size(), command) != Verdict::Good) {
      ++rejected_;
      return;
    }
    take(command, now_us);
  }

  /// Call at least every 10 ms.
  constexpr void tick(const ControllerInputs& inputs, std::uint32_t now_us) {
    if (sensed_) {
      left_turns_ = turns_after(left_turns_, inputs_.left_angle, inputs.left_angle);
      right_turns_ = turns_after(right_turns_, inputs_.right_angle, inputs.right_angle);
    }
    sensed_ = true;
    inputs_ = inputs;
    inputs_.emergency_stop = emergency_stop_.update(inputs.emergency_stop ? 1 : 0, now_us) != 0;
    inputs_.bumper = bumper_.update(inputs.bumper ? 1 : 0, now_us) != 0;
    inputs_.faults = faults_.update(inputs.faults, now_us);
    now_us_ = now_us;
    watch(now_us);
    if (clear()) {
      was_clear_ = true;
      return;
    }
    armed_ = running_ = false;
    if (was_clear_) stops_ = static_cast<std::uint8_t>((stops_ + 1U) % kStopsWrap);
    was_clear_ = false;
  }

  [[nodiscard]] constexpr DriveState state() const {
    if (inputs_.faults != kNoFault) return DriveState::Fault;
    if (inputs_.emergency_stop) return DriveState::EmergencyStop;
    if (inputs_.bumper) return DriveState::BumperStop;
    if (expired_) return DriveState::WatchdogStop;
    return running_ ? DriveState::Running : DriveState::Idle;
  }
  /// What the wheels shall do now, urad/s; zero unless Running.
  [[nodiscard]] constexpr std::int32_t left_uradps() const { return running_ ? command_.left_uradps : 0; }
  [[nodiscard]] constexpr std::int32_t right_uradps() const { return running_ ? command_.right_uradps : 0; }

  /// The next status frame into `out` (kMaxFrame bytes), from the inputs of the last tick(). Returns its
  /// length.
  constexpr std::size_t status_frame(std::uint8_t* out) { return encode(next_status(), out); }
  constexpr Status next_status() {
    Status status;
    status.sequence = status_sequence_++;
    status.command_sequence = command_.sequence;
    status.state = state();
    status.emergency_stop = inputs_.emergency_stop;
    status.bumper = inputs_.bumper;
    status.watchdog_expired = expired_;
    status.stops = stops_;
    status.faults = inputs_.faults;
    status.time_us = now_us_;
    status.left_angle = inputs_.left_angle;
    status.right_angle = inputs_.right_angle;
    status.left_turns = left_turns_;
    status.right_turns = right_turns_;
    status.battery_mv = inputs_.battery_mv;
    status.rejected_frames = rejected_;
    return status;
  }

 private:
  /// A repeated or late command is no sign of life: only a newer sequence number feeds the watchdog. After a
  /// silence any number is new, since the PC may have restarted.
  constexpr void take(const Command& command, std::uint32_t now_us) {
    watch(now_us);
    const auto step = static_cast<std::int16_t>(command.sequence - command_.sequence);
    if (fed_ && step <= 0) return;
    command_ = command;
    last_command_us_ = now_us;
    fed_ = true;
    expired_ = false;
    if (!command.enable) armed_ = clear();
    running_ = armed_ && clear() && command.enable;
  }

  /// Of inputs that were never read nobody knows.
  [[nodiscard]] constexpr bool clear() const {
    return sensed_ && !inputs_.emergency_stop && !inputs_.bumper && inputs_.faults == kNoFault;
  }

  constexpr void watch(std::uint32_t now_us) {
    if (!fed_ || now_us - last_command_us_ < kWatchdogMicroseconds) return;
    fed_ = armed_ = running_ = false;
    expired_ = true;
  }

  static constexpr std::int16_t turns_after(std::int16_t turns, std::uint16_t before, std::uint16_t after) {
    const int step = static_cast<int>(after) - static_cast<int>(before);
    if (step > kCountsPerTurn / 2) return static_cast<std::int16_t>(static_cast<std::uint16_t>(turns) - 1U);
    if (step < -kCountsPerTurn / 2) return static_cast<std::int16_t>(static_cast<std::uint16_t>(turns) + 1U);
    return turns;
  }

  FrameCutter cutter_;
  Command command_;
  ControllerInputs inputs_;
  ToldCause emergency_stop_;
  ToldCause bumper_;
  ToldCause faults_;
  std::uint32_t now_us_ = 0;
  std::uint32_t last_command_us_ = 0;
  std::uint32_t overflows_ = 0;
  std::int16_t left_turns_ = 0;
  std::int16_t right_turns_ = 0;
  std::uint16_t status_sequence_ = 0;
  std::uint16_t rejected_ = 0;
  std::uint8_t stops_ = 0;
  bool was_clear_ = true;
  bool sensed_ = false;
  bool fed_ = false;
  bool expired_ = false;
  bool armed_ = false;
  bool running_ = false;
};

}  // namespace madori::control::wire
