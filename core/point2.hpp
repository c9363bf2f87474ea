#pragma once

#include <cmath>

namespace madori {

/// A point of frame F, metres.
template <class F>
struct Point2 {
  double x_m = 0.0;
  double y_m = 0.0;

  friend bool operator==(const Point2&, const Point2&) = default;
};

template <class F>
[[nodiscard]] double distance_m(const Point2<F>& a, const Point2<F>& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m);
}

/// A straight piece between two points of frame F, metres.
template <class F>
struct Segment2 {
  Point2<F> a;
  Point2<F> b;

  [[nodiscard]] double length_m() const { return distance_m(a, b); }
  friend bool operator==(const Segment2&, const Segment2&) = default;
};

}  // namespace madori
