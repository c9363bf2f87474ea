#include "planning/obstacle_check/clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/segment_distance.hpp"

namespace madori::planning {
namespace {

/// The depth of a point that moves along a segment is the largest of four linear functions, so its least
/// value lies at an end or where two of them meet.
double deepest_m(const VehicleOutline& o, const Segment2<Base>& s) {
  struct Side {
    double at_a, step;
  };
  const double dx = s.b.x_m - s.a.x_m, dy = s.b.y_m - s.a.y_m;
  const std::array<Side, 4> sides{Side{s.a.x_m - o.front_m, dx}, Side{-s.a.x_m - o.rear_m, -dx},
                                  Side{s.a.y_m - o.half_width_m, dy}, Side{-s.a.y_m - o.half_width_m, -dy}};
  const auto depth = [&](double t) {
    double largest = -1e9;
    for (const Side& side : sides) largest = std::max(largest, side.at_a + t * side.step);
    return largest;
  };
  double least = std::min(depth(0.0), depth(1.0));
  for (std::size_t i = 0; i < sides.size(); ++i)
    for (std::size_t k = i + 1; k < sides.size(); ++k) {
      const double slope = sides[i].step - sides[k].step;
      const double t = (sides[k].at_a - sides[i].at_a) / slope;
      if (slope != 0.0 && t > 0.0 && t < 1.0) least = std::min(least, depth(t));
    }
  return least;
}

}  // namespace

double clearance_m(const VehicleOutline& o, const Point2<Base>& p) {
  const double x = std::max(p.x_m - o.front_m, -o.rear_m - p.x_m);
  const double y = std::abs(p.y_m) - o.half_width_m;
  return x <= 0.0 || y <= 0.0 ? std::max(x, y) : std::hypot(x, y);
}

double clearance_m(const VehicleOutline& o, const Segment2<Base>& s) {
  if (o.touches(s)) return deepest_m(o, s);
  double least = std::min(clearance_m(o, s.a), clearance_m(o, s.b));
  for (const double x : {o.front_m, -o.rear_m})
    for (const double y : {o.half_width_m, -o.half_width_m})
      least = std::min(least, distance_m(s, Point2<Base>{x, y}));
  return least;
}

}  // namespace madori::planning
