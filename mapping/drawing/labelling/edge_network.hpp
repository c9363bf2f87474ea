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
  std::array<End, 2> ends;     ///< the end with the longer neighbour first
  int abutting = 0;            ///< ends of others on this edge, between its own ends
  double chain_px = 0;         ///< all edges on the same straight line with no gap wider than a doorway
  double chain_extent_px = 0;  ///< from the first end to the last of those
  std::size_t chain = 0;       ///< the same number for all of a chain
  double line_px = 0;          ///< all edges on the same straight line of the sheet
  double cluster_px = 0;       ///< total length of all edges that hang together
  double cluster_size_px = 0;  ///< diagonal of the box around them
  int cluster_edges = 0;
  std::size_t cluster = 0;  ///< the same number for all of a cluster
};

[[nodiscard]] std::vector<EdgeLinks> link_edges(const EdgeSheet& sheet, const std::vector<EdgeViews>& views);

}  // namespace madori::mapping
