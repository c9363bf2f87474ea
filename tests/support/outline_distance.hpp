#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/segment_distance.hpp"

namespace madori::test {

/// Whether a convex outline of three corners or more, turning either way, holds a point.
template <class F>
[[nodiscard]] bool is_inside(const std::vector<Point2<F>>& outline, const Point2<F>& p) {
  if (outline.size() < 3) return false;
  int turns = 0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    turns += side_of(outline[i], outline[(i + 1) % outline.size()], p) > 0.0 ? 1 : -1;
  return std::abs(turns) == static_cast<int>(outline.size());
}

/// Metres from a point to a convex outline; zero inside.
template <class F>
[[nodiscard]] double distance_to(const std::vector<Point2<F>>& outline, const Point2<F>& p) {
  if (is_inside(outline, p)) return 0.0;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i)
    nearest_m =
        std::min(nearest_m, distance_m(Segment2<F>{outline[i], outline[(i + 1) % outline.size()]}, p));
  return nearest_m;
}

}  // namespace madori::test
