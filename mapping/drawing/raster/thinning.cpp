#include "mapping/drawing/raster/thinning.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace madori::mapping {
namespace {

/// Whether a pixel with these neighbours (bit 0 = above, then clockwise) goes in the first or second half
/// step.
constexpr bool goes(unsigned neighbours, bool second) {
  const auto p = [neighbours](unsigned i) { return (neighbours >> (i & 7U) & 1U) != 0; };
  int parts = 0, left = 0, right = 0;  // Guo and Hall: C(P), N1(P), N2(P)
  for (unsigned i = 0; i < 8; i += 2) {
    parts += !p(i) && (p(i + 1) || p(i + 2));
    left += p(i + 7) || p(i);
    right += p(i) || p(i + 1);
  }
  const int most = left < right ? left : right;
  if (parts != 1 || most < 2 || most > 3) return false;
  return second ? !((p(4) || p(5) || !p(7)) && p(6)) : !((p(0) || p(1) || !p(3)) && p(2));
}

constexpr auto make_table() {
  std::array<std::array<bool, 256>, 2> table{};
  for (unsigned n = 0; n < 256; ++n) {
    table[0][n] = goes(n, false);
    table[1][n] = goes(n, true);
  }
  return table;
}

void clear_border(GrayImage& ink) {
  const auto width = static_cast<std::size_t>(ink.width_px), size = ink.pixels.size();
  std::fill_n(ink.pixels.begin(), width, std::uint8_t{0});
  std::fill_n(ink.pixels.end() - static_cast<std::ptrdiff_t>(width), width, std::uint8_t{0});
  for (std::size_t at = 0; at < size; at += width) ink.pixels[at] = ink.pixels[at + width - 1] = 0;
}

std::vector<std::size_t> ink_pixels(const GrayImage& ink) {
  std::vector<std::size_t> found;
  const std::size_t size = ink.pixels.size();
  for (std::size_t at = 0; at < size;) {
    std::uint64_t eight = 0;
    if (at + 8 <= size && (std::memcpy(&eight, &ink.pixels[at], 8), eight == 0)) {
      at += 8;
      continue;
    }
    if (ink.pixels[at] != 0) found.push_back(at);
    ++at;
  }
  return found;
}

}  // namespace

void thin(GrayImage& ink) {
  if (ink.empty()) return;
  static constexpr auto kTable = make_table();
  clear_border(ink);
  std::vector<std::size_t> alive = ink_pixels(ink), gone;
  const auto width = static_cast<std::ptrdiff_t>(ink.width_px);
  const std::array<std::ptrdiff_t, 8> around{-width, -width + 1, 1,  width + 1,
                                             width,  width - 1,  -1, -width - 1};
  const auto neighbours = [&](std::size_t at) {
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i)
      bits |= (ink.pixels[at + static_cast<std::size_t>(around[i])] != 0 ? 1U : 0U) << i;
    return bits;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& table : kTable) {
      gone.clear();
      for (const std::size_t at : alive)
        if (table[neighbours(at)]) gone.push_back(at);
      for (const std::size_t at : gone) ink.pixels[at] = 0;
      if (gone.empty()) continue;
      changed = true;
      std::erase_if(alive, [&](std::size_t at) { return ink.pixels[at] == 0; });
    }
  }
}

}  // namespace madori::mapping
