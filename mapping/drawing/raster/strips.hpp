#pragma once

#include <cstddef>
#include <vector>

#include "mapping/drawing/gray_image.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

/// Two lines that run side by side: the two faces of a wall, or the edges of a table.
struct Strip {
  std::size_t line = 0, partner = 0;
  double width_px = 0;
  double from_px = 0, to_px = 0;  ///< along `line`, from its first end
  double ink_share = 0;           ///< of its length with ink between: 0 empty, near 1 hatched or solid

  [[nodiscard]] double length_px() const { return to_px - from_px; }
};

/// Every stretch of every line with the next parallel line on each side of it, up to `widest_px` away. Lines
/// that cross (hatching) do not stand between two faces. `ink` is the binarized drawing.
[[nodiscard]] std::vector<Strip> find_strips(const DrawnLines& lines, const GrayImage& ink, double widest_px);

}  // namespace madori::mapping
