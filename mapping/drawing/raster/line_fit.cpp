#include "mapping/drawing/raster/line_fit.hpp"

#include <algorithm>
#include <cmath>

namespace madori::mapping {

FittedLine line_through(const PixelSegment& s) {
  const double length = std::max(1e-9, s.length_px());
  return {0.5 * (s.u1 + s.u2), 0.5 * (s.v1 + s.v2), (s.u2 - s.u1) / length, (s.v2 - s.v1) / length};
}

}  // namespace madori::mapping
