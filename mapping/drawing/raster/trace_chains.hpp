#pragma once

#include <vector>

#include "mapping/drawing/gray_image.hpp"
#include "mapping/drawing/raster/line_fit.hpp"

namespace madori::mapping {

/// A bent line of the drawing: corner points, pixels.
struct Chain {
  std::vector<LinePoint> corners;
  bool solid_face = false;
};

/// What the straight lines left over: walks connected free pixels of the line picture end to end and
/// simplifies each walk (D. Douglas, T. Peucker, 1973) to within `tolerance_px`. Curved walls, door arcs and
/// short stubs come out here. The pixels become kTaken.
[[nodiscard]] std::vector<Chain> trace_chains(GrayImage& lines, double tolerance_px,
                                              std::size_t least_pixels);

}  // namespace madori::mapping
