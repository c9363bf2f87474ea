#pragma once

#include <array>
#include <vector>

#include "mapping/drawing/labelling/edge_rays.hpp"
#include "mapping/drawing/labelling/edge_sheet.hpp"

namespace madori::mapping {

/// How an edge hangs together with others. Lengths in pixels of the sheet.
struct EdgeLinks {
  struct End {
    int continuing = 0;         ///< edges that go on in the same direction
    int corners = 0, tees = 0;  ///< ends of others here; others that pass here
    double turn_rad = 0;        ///< of the straightest other that ends here; 0 without one
    double longest_px = 0;      ///< of those that turn off
  };
  std::array<End, 2> ends;  ///< the end with the longer neighbour first
  int abutting = 0;         ///< ends of others on this edge, between its own ends
  double line_px = 0;       ///< all edges on the same straight line of the sheet
  struct Group {
    std::size_t number = 0;  ///< the same for all of a group
    int edges = 0;
    double length_px = 0;  ///< of all together
    double extent_px = 0;  ///< from the first end to the last, or the diagonal of the box around them
  };
  Group chain;    ///< edges on the same straight line with no gap wider than a doorway
  Group cluster;  ///< edges that hang together
};

[[nodiscard]] std::vector<EdgeLinks> link_edges(const EdgeSheet& sheet, const std::vector<EdgeViews>& views);

}  // namespace madori::mapping
