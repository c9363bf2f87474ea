#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/laser_scan.hpp"
#include "core/result.hpp"
#include "sensors/lms1xx/cola.hpp"

namespace madori::sensors::lms1xx {

/// One output channel; DIST1 in millimetres times scale, RSSI1 without unit.
template <class Value>
struct Channel {
  std::array<char, 5> name{};
  float scale = 1.0F;
  float offset = 0.0F;
  std::int32_t start_angle = -450'000;  ///< 1e-4 deg, counter-clockwise, 90 deg is straight ahead
  std::uint16_t angle_step = 5'000;     ///< 1e-4 deg
  std::vector<Value> values;

  friend bool operator==(const Channel&, const Channel&) = default;
};

struct EncoderReading {
  std::uint32_t position = 0;
  std::uint16_t speed = 0;

  friend bool operator==(const EncoderReading&, const EncoderReading&) = default;
};

/// The body of an LMDscandata telegram up to its channels.
struct ScanData {
  std::uint16_t version = 1;
  std::uint16_t device = 1;
  std::uint32_t serial = 0;
  std::array<std::uint8_t, 2>
      status{};  ///< second byte: 0 good, 1 error, 2 pollution warning, 4 (LMS5xx: 5) pollution error
  std::uint16_t telegram_counter = 0;
  std::uint16_t scan_counter = 0;
  std::uint32_t scan_time_us = 0;      ///< since power-up, at the beginning of the scan; wraps
  std::uint32_t transmit_time_us = 0;  ///< since power-up, when the telegram was sent; wraps
  std::array<std::uint8_t, 2> inputs{};
  std::array<std::uint8_t, 2> outputs{};
  std::uint16_t layer = 0;
  std::uint32_t scan_frequency = 5'000;       ///< 0.01 Hz
  std::uint32_t measurement_frequency = 360;  ///< 100 Hz
  std::vector<EncoderReading> encoders;
  std::vector<Channel<std::uint16_t>> channels16;
  std::vector<Channel<std::uint8_t>> channels8;

  friend bool operator==(const ScanData&, const ScanData&) = default;
};

/// Reads the payload of `sSN LMDscandata` or `sRA LMDscandata`. What follows the channels (position, name,
/// comment, time) is ignored. A failure names the field where the telegram is damaged; at most 4096 values a
/// channel, 10 channels of each kind (five echoes, and RSSI of each), 4 encoders.
[[nodiscard]] Result<ScanData> decode_scan(Dialect dialect, std::span<const std::uint8_t> payload);

/// Channel DIST1 (or DIST2 where there is no other) as a scan of the Lidar frame: x forward, which is 90 deg
/// of the device. Values below 16 and those beyond 16 bits are no ranges; RSSI1 becomes the intensities. The
/// stamp stays unset. Fails without a distance channel, on scales or angles that are no numbers, and where
/// the scanner says of itself that it does not measure (an error, a front screen that is too dirty).
[[nodiscard]] Result<LaserScan> to_laser_scan(const ScanData& data);

}  // namespace madori::sensors::lms1xx
