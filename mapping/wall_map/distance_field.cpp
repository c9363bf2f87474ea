#include "mapping/wall_map/distance_field.hpp"

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

}  // namespace madori::mapping
