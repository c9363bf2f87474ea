#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

/// The packets of a Velodyne VLP-16 (User Manual 63-9243, chapter 9 "Sensor Data").
namespace madori::sensors::vlp16 {

inline constexpr std::uint16_t kDataPort = 2368;
inline constexpr std::uint16_t kPositionPort = 8308;
inline constexpr std::size_t kDataBytes = 1206;
inline constexpr std::size_t kPositionBytes = 512;

inline constexpr std::size_t kBlocks = 12;    ///< a data packet
inline constexpr std::size_t kChannels = 16;  ///< lasers
inline constexpr std::size_t kReturns = 32;   ///< a block: two firings of all lasers
inline constexpr double kChannelUs = 2.304;   ///< from laser to laser
inline constexpr double kFiringUs = 55.296;   ///< from firing to firing
inline constexpr double kMetresPerUnit = 0.002;
inline constexpr std::uint32_t kMicrosecondsPerHour = 3'600'000'000U;

/// Elevation of each laser in the order of firing, degrees.
inline constexpr std::array<int, kChannels> kElevationsDeg{-15, 1, -13, 3,  -11, 5,  -9, 7,
                                                           -7,  9, -5,  11, -3,  13, -1, 15};
/// Place of a laser when all are sorted by elevation, lowest first.
[[nodiscard]] constexpr std::uint8_t ring_of(std::size_t channel) {
  return static_cast<std::uint8_t>((kElevationsDeg[channel] + 15) / 2);
}

enum class ReturnMode : std::uint8_t { Strongest = 0x37, Last = 0x38, Dual = 0x39 };

struct Return {
  std::uint16_t distance = 0;  ///< 2 mm units; 0 = nothing came back
  std::uint8_t reflectivity = 0;

  friend bool operator==(const Return&, const Return&) = default;
};

/// Two firings. In dual-return mode blocks 2k (last) and 2k+1 (strongest; where that is the last one, the
/// second strongest) tell of the same two firings.
struct Block {
  std::uint16_t azimuth_cdeg =
      0;  ///< of the first laser of the first firing, 0.01 deg, clockwise seen from above
  std::array<Return, kReturns> returns{};

  friend bool operator==(const Block&, const Block&) = default;
};

struct DataPacket {
  std::array<Block, kBlocks> blocks{};
  std::uint32_t time_us =
      0;  ///< of the first firing, microseconds past the hour (or since power-up, without GPS)
  ReturnMode mode = ReturnMode::Strongest;
  std::uint8_t product = 0x22;

  friend bool operator==(const DataPacket&, const DataPacket&) = default;
};

/// How long after the packet's time a return was measured.
[[nodiscard]] constexpr double time_offset_us(ReturnMode mode, std::size_t block, std::size_t index) {
  const std::size_t block_firings = 2 * (mode == ReturnMode::Dual ? block / 2 : block);
  const std::size_t firing = block_firings + index / kChannels;
  return kFiringUs * static_cast<double>(firing) + kChannelUs * static_cast<double>(index % kChannels);
}
/// What the packets of this mode are apart.
[[nodiscard]] constexpr double packet_us(ReturnMode mode) {
  return kFiringUs * (mode == ReturnMode::Dual ? kBlocks : 2 * kBlocks);
}

/// Why bytes are no data packet of a VLP-16.
enum class PacketFault { None, Length, BlockFlag, Azimuth, Time, Mode, Product };
inline constexpr std::size_t kPacketFaults = static_cast<std::size_t>(PacketFault::Product) + 1;
[[nodiscard]] const char* to_string(PacketFault fault);
/// The name of the maker's other product whose product byte this is; nullptr where it may be a VLP-16's.
[[nodiscard]] const char* other_product(std::uint8_t product);

/// Reads a data packet of any length into `packet`, which is complete only when the answer is None. Refused
/// are wrong flags, azimuths beyond 360 deg, times of an hour and more, unknown modes, and the products
/// that are known not to be a VLP-16 (0x21 stays: early VLP-16 say so, and so does the HDL-32E).
[[nodiscard]] PacketFault decode(std::span<const std::uint8_t> bytes, DataPacket& packet);

struct PositionPacket {
  std::uint32_t time_us = 0;  ///< microseconds past the hour
  std::uint8_t pps = 0;       ///< 0 absent, 1 synchronizing, 2 locked, 3 error
  std::string gprmc;          ///< "$GPRMC,..." without line end; empty when the GPS says nothing
};
/// Nothing for bytes that are no position packet; other lengths come on that port and are to be ignored.
[[nodiscard]] std::optional<PositionPacket> decode_position(std::span<const std::uint8_t> bytes);

}  // namespace madori::sensors::vlp16
