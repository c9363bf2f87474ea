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
  double way = 0.0;
  while (way < limit_m) {
    const double d = distance_m({from.x_m + way * dx, from.y_m + way * dy});
    if (d <= touch) return way;
    way += std::max(d - 0.75 * cell, 0.5 * cell);
  }
  return limit_m;
}

}  // namespace madori::mapping
