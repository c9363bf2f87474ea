#pragma once

#include <algorithm>

#include "core/point2.hpp"

namespace madori {

/// The point of a segment nearest to `p`.
template <class F>
[[nodiscard]] Point2<F> nearest_point(const Segment2<F>& s, const Point2<F>& p) {
  const double dx = s.b.x_m - s.a.x_m;
  const double dy = s.b.y_m - s.a.y_m;
  const double square = dx * dx + dy * dy;
  const double t = square > 0.0 ? ((p.x_m - s.a.x_m) * dx + (p.y_m - s.a.y_m) * dy) / square : 0.0;
  const double share = std::clamp(t, 0.0, 1.0);
  return {s.a.x_m + share * dx, s.a.y_m + share * dy};
}

template <class F>
[[nodiscard]] double distance_m(const Segment2<F>& s, const Point2<F>& p) {
  return distance_m(nearest_point(s, p), p);
}

/// Twice the signed area of the triangle a, b, p: positive where p lies left of a -> b.
template <class F>
[[nodiscard]] double side_of(const Point2<F>& a, const Point2<F>& b, const Point2<F>& p) {
  return (b.x_m - a.x_m) * (p.y_m - a.y_m) - (b.y_m - a.y_m) * (p.x_m - a.x_m);
}

/// Zero where the segments cross or touch.
template <class F>
[[nodiscard]] double distance_m(const Segment2<F>& s, const Segment2<F>& t) {
  if (side_of(s.a, s.b, t.a) * side_of(s.a, s.b, t.b) < 0.0 &&
      side_of(t.a, t.b, s.a) * side_of(t.a, t.b, s.b) < 0.0)
    return 0.0;
  return std::min({distance_m(s, t.a), distance_m(s, t.b), distance_m(t, s.a), distance_m(t, s.b)});
}

}  // namespace madori
