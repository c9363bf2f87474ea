#pragma once

#include <algorithm>
#include <opencv2/core/types.hpp>
#include <vector>

#include "mapping/drawing/labelling/edge_sheet.hpp"

namespace madori::mapping {

/// The area of the sheet that an edge bounds on one side: a room, the body of a wall, the seat of a chair.
struct Region {
  double area_px = 0;
  cv::Size2d box_px;  ///< of the box around it
  double grey = 0;
  bool at_border = false;  ///< reaches the border of the sheet: the ground

  [[nodiscard]] double short_side_px() const { return std::min(box_px.width, box_px.height); }
  [[nodiscard]] double long_side_px() const { return std::max(box_px.width, box_px.height); }
};

struct EdgeRegions {
  Region dark, bright;
};

[[nodiscard]] std::vector<EdgeRegions> regions_beside(const EdgeSheet& sheet);

}  // namespace madori::mapping
