#pragma once

#include <cstdint>
#include <string_view>

namespace madori {

/// FNV-1a of the bytes, 64 bits: tells that something has changed or is damaged; no protection against
/// intent.
[[nodiscard]] constexpr std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3U;
  return hash;
}

}  // namespace madori
