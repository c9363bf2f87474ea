#pragma once

#include <vector>

#include "mapping/drawing/pixel_segment.hpp"

namespace madori::mapping {

/// How far the main directions of the walls are turned, (-45, 45] degrees, counter-clockwise as one looks at
/// the drawing: the peak of the wall directions modulo 90 degrees, weighted by length. 0 without walls.
[[nodiscard]] double measure_skew_deg(const std::vector<PixelSegment>& walls);

/// Turns every wall that misses a main direction by less than a pixel at its ends onto it, about its middle.
void straighten(std::vector<PixelSegment>& walls, double skew_deg);

}  // namespace madori::mapping
