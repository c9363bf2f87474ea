#pragma once

#include <cstdint>

/// Bytes and numbers on the wire. No call reads or writes outside the bytes that its name says.
namespace madori::sensors {

[[nodiscard]] constexpr std::uint16_t get_u16_le(const std::uint8_t* at) {
  return static_cast<std::uint16_t>(at[0] | (static_cast<unsigned>(at[1]) << 8U));
}
[[nodiscard]] constexpr std::uint32_t get_u32_le(const std::uint8_t* at) {
  return get_u16_le(at) | (static_cast<std::uint32_t>(get_u16_le(at + 2)) << 16U);
}
constexpr void put_u16_le(std::uint8_t* at, std::uint16_t value) {
  at[0] = static_cast<std::uint8_t>(value & 0xFFU);
  at[1] = static_cast<std::uint8_t>(value >> 8U);
}
constexpr void put_u32_le(std::uint8_t* at, std::uint32_t value) {
  put_u16_le(at, static_cast<std::uint16_t>(value & 0xFFFFU));
  put_u16_le(at + 2, static_cast<std::uint16_t>(value >> 16U));
}

}  // namespace madori::sensors
