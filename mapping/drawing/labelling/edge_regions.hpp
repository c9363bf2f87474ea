#pragma once

#include <array>
#include <vector>

#include "mapping/drawing/labelling/edge_sheet.hpp"

namespace madori::mapping {

/// The area of the sheet that an edge bounds on one side: a room, the body of a wall, the seat of a chair.
struct Region {
  double area_px = 0;
  double box_area_px = 0;
  double short_side_px = 0, long_side_px = 0;  ///< of the box around it
  double grey = 0;
  bool at_border = false;  ///< reaches the border of the sheet: the ground
};

struct EdgeRegions {
  Region dark, bright;
};

[[nodiscard]] std::vector<EdgeRegions> regions_beside(const EdgeSheet& sheet);

}  // namespace madori::mapping
