#pragma once

#include <cmath>
#include <set>
#include <utility>

#include "localization/registration/point_map.hpp"

namespace madori::test {

/// Points a square metre of the map's own surface: 1/(2 sqrt(density)) is what e_psr comes to by chance among
/// them.
[[nodiscard]] inline double points_per_m2(const localization::PointMap& map) {
  constexpr double kCellM = 0.5;
  std::set<std::pair<double, double>> cells;
  for (const Point2<Map>& p : map.points())
    cells.emplace(std::floor(p.x_m / kCellM), std::floor(p.y_m / kCellM));
  const double area_m2 = static_cast<double>(cells.size()) * kCellM * kCellM;
  return area_m2 > 0.0 ? static_cast<double>(map.points().size()) / area_m2 : 0.0;
}

}  // namespace madori::test
