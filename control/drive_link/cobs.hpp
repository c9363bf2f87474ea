#pragma once

#include <cstddef>
#include <cstdint>

/// Consistent overhead byte stuffing (Cheshire and Baker, 1999): no zero byte within a frame, so that a zero
/// ends one. Freestanding: no heap, no exceptions, no library.
namespace madori::control::wire {

/// Bytes that encoding of up to 254 bytes adds.
inline constexpr std::size_t kCobsOverhead = 1;

/// Encodes `count` (at most 254) bytes into `out`, which holds count + kCobsOverhead. Returns the encoded
/// length.
constexpr std::size_t cobs_encode(const std::uint8_t* bytes, std::size_t count, std::uint8_t* out) {
  std::size_t code_at = 0;
  std::size_t used = 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (bytes[i] == 0) {
      out[code_at] = static_cast<std::uint8_t>(used - code_at);
      code_at = used++;
    } else {
      out[used++] = bytes[i];
    }
  }
  out[code_at] = static_cast<std::uint8_t>(used - code_at);
  return used;
}

/// Decodes `count` bytes into `out`, which holds `capacity`. Returns the decoded length, or 0 when the frame
/// is damaged or does not fit.
constexpr std::size_t cobs_decode(const std::uint8_t* bytes, std::size_t count, std::uint8_t* out,
                                  std::size_t capacity) {
  std::size_t used = 0;
  std::size_t i = 0;
  while (i < count) {
    const std::size_t code = bytes[i];
    if (code == 0 || i + code > count) return 0;
    for (std::size_t k = 1; k < code; ++k) {
      if (bytes[i + k] == 0 || used >= capacity) return 0;
      out[used++] = bytes[i + k];
    }
    i += code;
    if (i < count && code != 0xFF) {
      if (used >= capacity) return 0;
      out[used++] = 0;
    }
  }
  return used;
}

}  // namespace madori::control::wire
