#pragma once

#include <array>
#include <vector>

#include "mapping/drawing/labelling/edge_sheet.hpp"

namespace madori::mapping {

/// What a look across an edge, to one of its sides, meets: medians over places all along the edge. Pixels of
/// the sheet.
struct SideView {
  static constexpr int kHits = 3;
  struct ParallelHit {
    double distance_px = 0;    ///< 0 where less than a third of the places meet one
    double share = 0;          ///< of the places that meet a parallel edge
    double opposite = 0;       ///< share of them with the dark side turned the other way
    double free_after_px = 0;  ///< to the next edge of any direction behind it
    int edge = -1;             ///< the one that most places meet
  };
  std::array<ParallelHit, kHits> hits;
  double free_px = 0, free_most_px = 0;       ///< to the first edge of any direction: median, largest
  double open = 0;                            ///< share of the places that see the border of the sheet
  double near_grey = 0;                       ///< brightness beside the edge
  double red_green = 128, yellow_blue = 128;  ///< its colour there
  double fill_grey = 0, fill_spread = 0;      ///< brightness up to the first parallel edge
};

/// Between what an edge's line goes on past one of its ends: the faces of a wall in whose opening a door leaf
/// or a pane lies. Pixels to the first parallel edge on either side, 0 where there is none.
struct Between {
  double left_px = 0, right_px = 0;
  [[nodiscard]] double width_px() const { return left_px > 0 && right_px > 0 ? left_px + right_px : 0; }
};

struct EdgeViews {
  SideView dark, bright;
  std::array<Between, 2> past_ends;
};

[[nodiscard]] std::vector<EdgeViews> look_across(const EdgeSheet& sheet);

}  // namespace madori::mapping
