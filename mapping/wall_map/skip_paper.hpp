#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace madori::mapping {

/// The first element from `at` that is not 0, `end` where there is none: eight at once, since most of a
/// drawing is empty paper.
[[nodiscard]] inline std::size_t skip_paper(const std::uint8_t* pixels, std::size_t at, std::size_t end) {
  for (; at + 8 <= end; at += 8) {
    std::uint64_t eight{};
    std::memcpy(&eight, pixels + at, 8);
    if (eight != 0) break;
  }
  while (at < end && pixels[at] == 0) ++at;
  return at;
}

}  // namespace madori::mapping
