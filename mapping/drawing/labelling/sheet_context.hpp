#pragma once

#include <array>
#include <vector>

#include "mapping/drawing/labelling/feature_table.hpp"
#include "mapping/drawing/pixel_segment.hpp"

namespace madori::mapping {

/// Which edges of a sheet belong together, one number or -1 an edge.
struct EdgeGroups {
  /// Closely and roughly alike, on one straight line, hanging together: the same number in one group.
  std::array<std::vector<int>, 4> together;
  std::array<std::vector<int>, 2> partner;  ///< the parallel edge over the dark, the bright side; -1 without
};

/// What a first judgement of all edges says about each: how probable its sheet, its style, its line, its
/// neighbours are walls. All relative to the sheet, so that a second judgement can tell what is a wall on
/// this sheet, however the first one leans. `probabilities` one an edge.
[[nodiscard]] FeatureTable sheet_context(const std::vector<PixelSegment>& edges, const EdgeGroups& groups,
                                         const std::vector<float>& probabilities);

}  // namespace madori::mapping
