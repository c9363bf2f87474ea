#include "localization/particle_filter/beam_path.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

/// True when a wall lies on the way from `from` along (dx, dy) within `length_m`.
bool blocked(const mapping::DistanceField& field, const Point2<Map>& from, double dx, double dy,
             double length_m) {
  const double cell = field.frame().cell_m;
  const double touch =
      0.5 * cell;  // no line through a cell with a wall in it stays farther than this everywhere
  double t = 0.0;
  while (t < length_m) {
    const double d = field.distance_m({from.x_m + t * dx, from.y_m + t * dy});
    if (d <= touch) return true;
    t += std::max(d - 0.75 * cell, 0.5 * cell);
  }
  return false;
}

}  // namespace

double share_through_walls(const ScanPoints& points, const mapping::DistanceField& field,
                           const Transform2<Map, Base>& map_from_base, const BeamPathOptions& options) {
  const std::size_t stride = 1 + points.size() / (std::max<std::size_t>(options.most_beams, 1) + 1);
  const Point2<Map> from = map_from_base.translation();
  double total = 0.0;
  double through = 0.0;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Point2<Map> end = map_from_base * points.point(i);
    const double length = distance_m(from, end);
    if (length <= options.end_margin_m) continue;
    total += points.weight_of(i);
    if (blocked(field, from, (end.x_m - from.x_m) / length, (end.y_m - from.y_m) / length,
                length - options.end_margin_m))
      through += points.weight_of(i);
  }
  return total > 0.0 ? through / total : 0.0;
}

}  // namespace madori::localization
