#include "mapping/wall_map/distance_field.hpp"

#include <algorithm>
#include <cmath>

namespace madori::mapping {

DistanceField::DistanceField(const Walls& walls, const DistanceFieldOptions& options)
    : frame_(GridFrame::around(walls, options.margin_m, options.cell_m)),
      max_distance_m_(options.max_distance_m),
      counts_(frame_.cells(), 255) {
  const double counts_per_m = 255.0 / max_distance_m_;
  for (const Wall& wall : walls)
    for_each_cell_near(frame_, wall.segment, max_distance_m_, [&](std::size_t cell, double d2) {
      const auto count = static_cast<std::uint8_t>(std::lround(std::sqrt(d2) * counts_per_m));
      if (count < counts_[cell]) counts_[cell] = count;
    });
}

double DistanceField::free_way_m(const Point2<Map>& from, double dx, double dy, double limit_m) const {
  const double cell = frame_.cell_m;
  const double touch = 0.71 * cell + 0.5 * m_per_count();  // centre of a cell that a wall runs through
  const double cells_per_m = 1.0 / cell;  // no division a step: millions of beams a minute walk here
  const double u0 = (from.x_m - frame_.origin.x_m) * cells_per_m, du = dx * cells_per_m;
  const double v0 = (from.y_m - frame_.origin.y_m) * cells_per_m, dv = dy * cells_per_m;
  double way = 0.0;
  while (way < limit_m) {
    const double u = u0 + way * du;
    const double v = v0 + way * dv;
    double d = max_distance_m_;
    if (u >= 0.0 && v >= 0.0 && u < frame_.width && v < frame_.height)
      d = counts_[frame_.index(static_cast<int>(u), static_cast<int>(v))] * m_per_count();
    if (d <= touch) return way;
    way += std::max(d - 0.75 * cell, 0.5 * cell);
  }
  return limit_m;
}

}  // namespace madori::mapping
