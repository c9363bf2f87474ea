#pragma once

#include <array>
#include <vector>

#include "mapping/drawing/pixel_segment.hpp"
#include "mapping/drawing/raster/components.hpp"

namespace madori::mapping {

/// A pillar: a small square mark, outlined or filled, that comes again in the same size at a distance.
struct Column {
  double side_px = 0;
  std::array<PixelSegment, 4> faces;
};

/// Square marks that stand alone, `taken` ones (text, dashes) left out. Thin lines that touch a square (the
/// axes of the grid) are cut off first. One of a kind is no column, and neither are squares that stand
/// together.
[[nodiscard]] std::vector<Column> find_columns(const Components& marks, const std::vector<bool>& taken,
                                               double pen_px);

}  // namespace madori::mapping
