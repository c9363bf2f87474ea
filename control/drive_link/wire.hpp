#pragma once

#include <cstddef>
#include <cstdint>

#include "control/drive_link/cobs.hpp"
#include "core/crc16.hpp"

/// The serial protocol between the vehicle's PC and the motor controller, version 1, byte by byte in
/// docs/reference/drive-link.md. Freestanding C++17: firmware includes this header as it is.
namespace madori::control::wire {

inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::uint8_t kCommandType = 0x01;
inline constexpr std::uint8_t kStatusType = 0x81;
inline constexpr std::size_t kCommandBytes = 16;  ///< before byte stuffing, with CRC
inline constexpr std::size_t kStatusBytes = 28;
inline constexpr std::size_t kMaxFrame =
    kStatusBytes + kCobsOverhead + 1;  ///< on the line, with the closing zero
inline constexpr std::uint32_t kWatchdogMicroseconds = 200'000;
inline constexpr std::int32_t kMaxWheelSpeed =
    100'000'000;  ///< urad/s; a faster command is refused as garbage
inline constexpr std::uint8_t kStopsWrap = 32;
inline constexpr std::int32_t kCountsPerTurn = 16'384;  ///< AS5048A, 14 bit

/// PC -> controller.
struct Command {
  std::uint16_t sequence = 0;
  bool enable = false;
  std::int32_t left_uradps = 0;  ///< wheel speed, micro-radians a second, positive drives forward
  std::int32_t right_uradps = 0;
};

enum class DriveState : std::uint8_t {
  Idle = 0,           ///< healthy, not enabled; the motors are held at zero
  Running = 1,        ///< follows the commands
  WatchdogStop = 2,   ///< no valid new command for 200 ms
  EmergencyStop = 3,  ///< the emergency-stop input is open
  BumperStop = 4,
  Fault = 5,
};

enum Fault : std::uint16_t {
  kNoFault = 0,
  kLeftEncoder = 1U << 0U,  ///< magnet missing, or parity wrong
  kRightEncoder = 1U << 1U,
  kLeftMotor = 1U << 2U,  ///< over-current or driver fault
  kRightMotor = 1U << 3U,
  kUndervoltage = 1U << 4U,
  kOvertemperature = 1U << 5U,
  kInternal = 1U << 6U,
};

/// Controller -> PC.
struct Status {
  std::uint16_t sequence = 0;
  std::uint16_t command_sequence = 0;  ///< of the last command that was taken
  DriveState state = DriveState::Idle;
  bool emergency_stop = false;
  bool bumper = false;
  bool watchdog_expired = false;
  std::uint8_t stops = 0;  ///< by emergency stop, bumper or fault since power-up, modulo kStopsWrap
  std::uint16_t faults = kNoFault;
  std::uint32_t time_us = 0;     ///< controller's clock when the encoders were read; wraps after 71.6 min
  std::uint16_t left_angle = 0;  ///< AS5048A, 0 ... 16383, grows while driving forward
  std::uint16_t right_angle = 0;
  std::int16_t left_turns = 0;  ///< whole turns since power-up, wraps
  std::int16_t right_turns = 0;
  std::uint16_t battery_mv = 0;
  std::uint16_t rejected_frames =
      0;  ///< damaged or unknown frames that the controller has thrown away, wraps
};

/// Whether a status tells of a stop by hand or bumper.
constexpr bool tells_stop(const Status& s) {
  return s.emergency_stop || s.bumper || s.state == DriveState::EmergencyStop ||
         s.state == DriveState::BumperStop;
}
constexpr bool tells_fault(const Status& s) {
  return s.faults != kNoFault || s.state == DriveState::Fault;
}

/// Why a frame was thrown away.
enum class Verdict : std::uint8_t { Good, BadStuffing, BadLength, BadVersion, BadType, BadCrc, BadValue };

namespace detail {

constexpr void put16(std::uint8_t* at, std::uint32_t value) {
  at[0] = static_cast<std::uint8_t>(value & 0xFFU);
  at[1] = static_cast<std::uint8_t>((value >> 8U) & 0xFFU);
}
constexpr void put32(std::uint8_t* at, std::uint32_t value) {
  put16(at, value & 0xFFFFU);
  put16(at + 2, value >> 16U);
}
constexpr std::uint16_t get16(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(at[0] | (static_cast<unsigned>(at[1]) << 8U));
}
constexpr std::uint32_t get32(const std::uint8_t* at) {
  return get16(at) | (static_cast<std::uint32_t>(get16(at + 2)) << 16U);
}

/// Header and CRC around a filled body, stuffed, closed by a zero. Returns the length on the line.
constexpr std::size_t seal(std::uint8_t* raw, std::size_t size, std::uint8_t type, std::uint16_t sequence,
                           std::uint8_t* out) {
  raw[0] = kVersion;
  raw[1] = type;
  put16(raw + 2, sequence);
  put16(raw + size - 2, crc16(raw, size - 2));
  const std::size_t stuffed = cobs_encode(raw, size, out);
  out[stuffed] = 0;
  return stuffed + 1;
}

/// Undoes seal() for a frame without its closing zero; `raw` holds kStatusBytes + 1.
constexpr Verdict unseal(const std::uint8_t* frame, std::size_t count, std::uint8_t type, std::size_t size,
                         std::uint8_t* raw) {
  const std::size_t got = cobs_decode(frame, count, raw, kStatusBytes + 1);
  if (got == 0) return Verdict::BadStuffing;
  if (got >= 2 && raw[0] != kVersion) return Verdict::BadVersion;
  if (got >= 2 && raw[1] != type) return Verdict::BadType;
  if (got != size) return Verdict::BadLength;
  if (crc16(raw, size - 2) != get16(raw + size - 2)) return Verdict::BadCrc;
  return Verdict::Good;
}

constexpr bool believable(std::int32_t speed) {
  return speed >= -kMaxWheelSpeed && speed <= kMaxWheelSpeed;
}

}  // namespace detail

/// Writes a frame with its closing zero into `out` (kMaxFrame bytes). Returns its length.
constexpr std::size_t encode(const Command& command, std::uint8_t* out) {
  std::uint8_t raw[kCommandBytes] = {};
  raw[4] = command.enable ? 1 : 0;
  detail::put32(raw + 6, static_cast<std::uint32_t>(command.left_uradps));
  detail::put32(raw + 10, static_cast<std::uint32_t>(command.right_uradps));
  return detail::seal(raw, kCommandBytes, kCommandType, command.sequence, out);
}

constexpr std::size_t encode(const Status& status, std::uint8_t* out) {
  std::uint8_t raw[kStatusBytes] = {};
  detail::put16(raw + 4, status.command_sequence);
  raw[6] = static_cast<std::uint8_t>(status.state);
  raw[7] = static_cast<std::uint8_t>((status.emergency_stop ? 1U : 0U) | (status.bumper ? 2U : 0U) |
                                     (status.watchdog_expired ? 4U : 0U) |
                                     (static_cast<unsigned>(status.stops % kStopsWrap) << 3U));
  detail::put16(raw + 8, status.faults);
  detail::put32(raw + 10, status.time_us);
  detail::put16(raw + 14, status.left_angle);
  detail::put16(raw + 16, status.right_angle);
  detail::put16(raw + 18, static_cast<std::uint16_t>(status.left_turns));
  detail::put16(raw + 20, static_cast<std::uint16_t>(status.right_turns));
  detail::put16(raw + 22, status.battery_mv);
  detail::put16(raw + 24, status.rejected_frames);
  return detail::seal(raw, kStatusBytes, kStatusType, status.sequence, out);
}

/// Reads a frame without its closing zero. `command` is touched only when the verdict is Good.
constexpr Verdict decode(const std::uint8_t* frame, std::size_t count, Command& command) {
  std::uint8_t raw[kStatusBytes + 1] = {};
  const Verdict verdict = detail::unseal(frame, count, kCommandType, kCommandBytes, raw);
  if (verdict != Verdict::Good) return verdict;
  const auto left = static_cast<std::int32_t>(detail::get32(raw + 6));
  const auto right = static_cast<std::int32_t>(detail::get32(raw + 10));
  if (raw[4] > 1 || raw[5] != 0 || !detail::believable(left) || !detail::believable(right))
    return Verdict::BadValue;
  command = Command{detail::get16(raw + 2), raw[4] == 1, left, right};
  return Verdict::Good;
}

constexpr Verdict decode(const std::uint8_t* frame, std::size_t count, Status& status) {
  std::uint8_t raw[kStatusBytes + 1] = {};
  const Verdict verdict = detail::unseal(frame, count, kStatusType, kStatusBytes, raw);
  if (verdict != Verdict::Good) return verdict;
  const std::uint16_t left = detail::get16(raw + 14), right = detail::get16(raw + 16);
  if (raw[6] > static_cast<std::uint8_t>(DriveState::Fault) || left >= kCountsPerTurn ||
      right >= kCountsPerTurn)
    return Verdict::BadValue;
  status.sequence = detail::get16(raw + 2);
  status.command_sequence = detail::get16(raw + 4);
  status.state = static_cast<DriveState>(raw[6]);
  status.emergency_stop = (raw[7] & 1U) != 0;
  status.bumper = (raw[7] & 2U) != 0;
  status.watchdog_expired = (raw[7] & 4U) != 0;
  status.stops = raw[7] >> 3U;
  status.faults = detail::get16(raw + 8);
  status.time_us = detail::get32(raw + 10);
  status.left_angle = left;
  status.right_angle = right;
  status.left_turns = static_cast<std::int16_t>(detail::get16(raw + 18));
  status.right_turns = static_cast<std::int16_t>(detail::get16(raw + 20));
  status.battery_mv = detail::get16(raw + 22);
  status.rejected_frames = detail::get16(raw + 24);
  return Verdict::Good;
}

/// Cuts a byte stream into frames. Feed every byte; frame() holds one whenever push() says so.
class FrameCutter {
 public:
  /// True when `byte` closed a frame that is not empty and not longer than any frame of this protocol.
  constexpr bool push(std::uint8_t byte) {
    if (closed_) size_ = 0, closed_ = false;
    if (byte != 0) {
      if (size_ < kMaxFrame)
        bytes_[size_++] = byte;
      else
        overflow_ = true;
      return false;
    }
    closed_ = true;
    const bool whole = size_ > 0 && !overflow_;
    if (overflow_) ++overflows_;
    overflow_ = false;
    return whole;
  }
  [[nodiscard]] constexpr const std::uint8_t* frame() const { return bytes_; }
  [[nodiscard]] constexpr std::size_t size() const { return size_; }
  [[nodiscard]] constexpr std::uint32_t overflows() const { return overflows_; }

 private:
  std::uint8_t bytes_[kMaxFrame] = {};
  std::size_t size_ = 0;
  bool closed_ = false;
  bool overflow_ = false;
  std::uint32_t overflows_ = 0;
};

}  // namespace madori::control::wire
