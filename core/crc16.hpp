#pragma once

#include <cstddef>
#include <cstdint>

namespace madori {

inline constexpr std::uint16_t kCrc16Start = 0xFFFF;

/// CRC-16 with the polynomial x^16 + x^12 + x^5 + 1 (0x1021), start 0xFFFF, not reflected, no final XOR
/// ("CRC-16/CCITT-FALSE", check value of "123456789": 0x29B1). Freestanding: firmware includes it too.
[[nodiscard]] constexpr std::uint16_t crc16(const std::uint8_t* bytes, std::size_t count,
                                            std::uint16_t crc = kCrc16Start) {
  constexpr std::uint16_t kNibble[16] = {0x0000, 0x1021, 0x2042, 0x3063, 0x4084, 0x50A5, 0x60C6, 0x70E7,
                                         0x8108, 0x9129, 0xA14A, 0xB16B, 0xC18C, 0xD1AD, 0xE1CE, 0xF1EF};
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned byte = bytes[i];
    crc = static_cast<std::uint16_t>((crc << 4U) ^ kNibble[(crc >> 12U) ^ (byte >> 4U)]);
    crc = static_cast<std::uint16_t>((crc << 4U) ^ kNibble[(crc >> 12U) ^ (byte & 0x0FU)]);
  }
  return crc;
}

}  // namespace madori
