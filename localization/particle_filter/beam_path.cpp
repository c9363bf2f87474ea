#include "localization/particle_filter/beam_path.hpp"

#include <algorithm>

namespace madori::localization {
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
    const double reach = length - options.end_margin_m;
    if (field.free_way_m(from, (end.x_m - from.x_m) / length, (end.y_m - from.y_m) / length, reach) < reach)
      through += points.weight_of(i);
  }
  return total > 0.0 ? through / total : 0.0;
}

}  // namespace madori::localization
