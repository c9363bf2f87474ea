#pragma once

#include <algorithm>
#include <cmath>

#include "mapping/drawing/pixel_segment.hpp"

namespace madori::mapping {

/// The box around what was added, pixels.
struct PixelBox {
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;

  void add(const PixelSegment& s) {
    left = std::min({left, s.u1, s.u2}), right = std::max({right, s.u1, s.u2});
    top = std::min({top, s.v1, s.v2}), bottom = std::max({bottom, s.v1, s.v2});
  }
  [[nodiscard]] double width() const { return std::max(0.0, right - left); }
  [[nodiscard]] double height() const { return std::max(0.0, bottom - top); }
  [[nodiscard]] double diagonal() const { return std::hypot(width(), height()); }
};

}  // namespace madori::mapping
