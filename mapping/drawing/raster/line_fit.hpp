#pragma once

#include "mapping/drawing/pixel_segment.hpp"

namespace madori::mapping {

struct LinePoint {
  double u = 0, v = 0;
};

/// An endless line in Hesse form with its middle, pixels.
struct FittedLine {
  double middle_u = 0, middle_v = 0;
  double direction_u = 1, direction_v = 0;  ///< unit length

  [[nodiscard]] double along(double u, double v) const {
    return (u - middle_u) * direction_u + (v - middle_v) * direction_v;
  }
  [[nodiscard]] double across(double u, double v) const {
    return (v - middle_v) * direction_u - (u - middle_u) * direction_v;
  }
  [[nodiscard]] PixelSegment segment(double from, double to) const {
    return {middle_u + from * direction_u, middle_v + from * direction_v, middle_u + to * direction_u,
            middle_v + to * direction_v};
  }
};

/// Through both ends of a segment of some length.
[[nodiscard]] FittedLine line_through(const PixelSegment& segment);

}  // namespace madori::mapping
