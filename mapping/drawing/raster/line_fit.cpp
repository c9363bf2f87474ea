#include "mapping/drawing/raster/line_fit.hpp"

#include <algorithm>
#include <cmath>

namespace madori::mapping {

FittedLine line_through(const PixelSegment& s) {
  const double length = std::max(1e-9, s.length_px());
  return {0.5 * (s.u1 + s.u2), 0.5 * (s.v1 + s.v2), (s.u2 - s.u1) / length, (s.v2 - s.v1) / length, 0};
}

FittedLine fit_line(const std::vector<LinePoint>& points) {
  const auto count = static_cast<double>(points.size());
  double mean_u = 0, mean_v = 0;
  for (const LinePoint& p : points) {
    mean_u += p.u / count;
    mean_v += p.v / count;
  }
  double uu = 0, uv = 0, vv = 0;
  for (const LinePoint& p : points) {
    uu += (p.u - mean_u) * (p.u - mean_u);
    uv += (p.u - mean_u) * (p.v - mean_v);
    vv += (p.v - mean_v) * (p.v - mean_v);
  }
  const double angle = 0.5 * std::atan2(2 * uv, uu - vv);
  const double smaller = 0.5 * (uu + vv - std::hypot(uu - vv, 2 * uv));
  return {mean_u, mean_v, std::cos(angle), std::sin(angle), std::sqrt(std::max(0.0, smaller) / count)};
}

}  // namespace madori::mapping
