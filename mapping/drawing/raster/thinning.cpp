#include "mapping/drawing/raster/thinning.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/drawing/raster/skip_paper.hpp"

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
  const std::uint8_t* pixels = ink.pixels.data();
  const std::size_t size = ink.pixels.size();
  for (std::size_t at = skip_paper(pixels, 0, size); at < size; at = skip_paper(pixels, at + 1, size))
    found.push_back(at);
  return found;
}

/// One picture while it is thinned: deletions of a half step happen at once, after all were decided.
class Thinner {
 public:
  explicit Thinner(GrayImage& ink)
      : pixels_(ink.pixels), alive_(ink_pixels(ink)), around_(steps_around(ink.width_px)) {
    for (const std::size_t at : alive_) pixels_[at] = kInk;
  }

  /// Deletes what goes in this half step and returns whether anything did.
  bool half_step(const std::array<bool, 256>& table) {
    const auto& asked = candidates();
    std::swap(gone_before_, gone_);
    gone_.clear();
    for (const std::size_t at : asked) {
      if (pixels_[at] != kInk || !table[neighbours(at)]) continue;
      gone_.push_back(at);
      pixels_[at] = kGoing;
    }
    for (const std::size_t at : gone_) pixels_[at] = 0;
    return !gone_.empty();
  }

  void leave(std::uint8_t value) {
    for (const std::size_t at : alive_)
      if (pixels_[at] != 0) pixels_[at] = value;
  }

 private:
  static constexpr std::uint8_t kInk = 255, kGoing = 1;
  static constexpr std::size_t kFew = 8;  // below this share of all ink the neighbours of what went are fewer

  static std::array<std::size_t, 8> steps_around(int width_px) {
    const auto width = static_cast<std::size_t>(width_px), back = ~std::size_t{0};  // -1, modulo its range
    return {0 - width, 1 - width, 1, width + 1, width, width - 1, back, back - width};
  }
  [[nodiscard]] unsigned neighbours(std::size_t at) const {
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i) bits |= (pixels_[at + around_[i]] != 0 ? 1U : 0U) << i;
    return bits;
  }
  /// Only what lost a neighbour since the same half step before can go now: in late rounds these are few.
  const std::vector<std::size_t>& candidates() {
    const std::size_t changes = gone_.size() + gone_before_.size();
    if (++half_steps_ <= 2 || changes * kFew > alive_.size()) {
      std::erase_if(alive_, [&](std::size_t at) { return pixels_[at] == 0; });
      return alive_;
    }
    near_.clear();
    for (const auto* gone : {&gone_, &gone_before_})
      for (const std::size_t at : *gone)
        for (const std::size_t step : around_)
          if (pixels_[at + step] != 0) near_.push_back(at + step);
    return near_;
  }

  std::vector<std::uint8_t>& pixels_;
  std::vector<std::size_t> alive_, near_, gone_, gone_before_;
  std::array<std::size_t, 8> around_;
  int half_steps_ = 0;
};

}  // namespace

void thin(GrayImage& ink, std::uint8_t value) {
  if (ink.empty()) return;
  static constexpr auto kTable = make_table();
  clear_border(ink);
  Thinner thinner(ink);
  for (bool changed = true; changed;) {
    changed = thinner.half_step(kTable[0]);
    changed = thinner.half_step(kTable[1]) || changed;
  }
  thinner.leave(value);
}

}  // namespace madori::mapping
