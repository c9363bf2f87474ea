#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace madori::mapping {

/// An 8-bit picture, row-major, row 0 on top; 255 = paper, 0 = ink. Transparency is already composed on
/// white.
struct GrayImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> pixels{};  ///< width_px * height_px
  double dpi = 0;                      ///< as the file states it; 0 = not stated
  /// Opponent colours, as many as pixels, 128 = neither; both empty where nothing is coloured.
  std::vector<std::uint8_t> red_green{}, yellow_blue{};

  [[nodiscard]] bool empty() const { return pixels.empty(); }
  [[nodiscard]] std::uint8_t at(int u, int v) const {
    return pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) +
                  static_cast<std::size_t>(u)];
  }
};

}  // namespace madori::mapping
