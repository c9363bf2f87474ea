#pragma once

#include <vector>

#include "mapping/drawing/raster/components.hpp"

namespace madori::mapping {

/// A word or number of the drawing.
struct TextGroup {
  std::vector<std::size_t> marks;  ///< indices of its characters
  double middle_u = 0, middle_v = 0;
  double angle_rad = 0;  ///< of the base line
  double length_px = 0, height_px = 0;
};

/// Letters and digits: small marks of like size that stand in a row, in any direction (after L. Fletcher,
/// R. Kasturi, "A robust algorithm for text string separation", PAMI 10, 1988). Marks already `taken` for
/// something else are left out.
[[nodiscard]] std::vector<TextGroup> find_text(const Components& marks, const std::vector<bool>& taken,
                                               double pen_px, int picture_size_px);

}  // namespace madori::mapping
