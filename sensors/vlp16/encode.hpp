#pragma once

#include <array>
#include <cstdint>

#include "sensors/vlp16/packet.hpp"

namespace madori::sensors::vlp16 {

/// The bytes that decode() reads back to the same packet.
[[nodiscard]] std::array<std::uint8_t, kDataBytes> encode(const DataPacket& packet);

/// The sentence is cut at the 128 bytes that the packet has for it; CR LF is appended.
[[nodiscard]] std::array<std::uint8_t, kPositionBytes> encode(const PositionPacket& packet);

}  // namespace madori::sensors::vlp16
