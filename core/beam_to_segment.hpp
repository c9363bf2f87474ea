#pragma once

#include <cmath>
#include <limits>

#include "core/point2.hpp"

namespace madori {

/// How far a beam from `p` along a unit vector goes until it meets the segment; infinite where it does not.
template <class F>
[[nodiscard]] double beam_meets_m(const Segment2<F>& s, const Point2<F>& p, double dx, double dy) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double ex = s.b.x_m - s.a.x_m, ey = s.b.y_m - s.a.y_m;
  const double ax = s.a.x_m - p.x_m, ay = s.a.y_m - p.y_m;
  const double det = dx * ey - dy * ex;
  if (std::abs(det) < 1e-12) return kNever;
  const double along_m = (ax * ey - ay * ex) / det, share = (ax * dy - ay * dx) / det;
  return along_m > 0.0 && share >= 0.0 && share <= 1.0 ? along_m : kNever;
}

}  // namespace madori
