#include "localization/registration/segment_grid.hpp"

#include <limits>

namespace madori::localization {

SegmentGrid::SegmentGrid(const mapping::Walls& walls, const SegmentGridOptions& options,
                         const std::vector<double>& reliability)
    : frame_(mapping::GridFrame::around(walls, options.radius_m, options.cell_m)),
      cells_per_m_(1.0 / options.cell_m),
      ids_(frame_.cells(), kNone) {
  std::vector<float> nearest(frame_.cells(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double weight = reliability.empty() ? 1.0 : reliability[i];
    const Segment2<Map>& s = walls[i].segment;
    const double length = s.length_m();
    if (weight <= 0.0 || length <= 0.0) continue;
    const auto id = static_cast<std::uint32_t>(segments_.size());
    segments_.push_back(
        {s.a.x_m, s.a.y_m, (s.b.x_m - s.a.x_m) / length, (s.b.y_m - s.a.y_m) / length, length, weight});
    mapping::for_each_cell_near(frame_, s, options.radius_m, [&](std::size_t cell, double d2) {
      if (static_cast<float>(d2) >= nearest[cell]) return;
      nearest[cell] = static_cast<float>(d2);
      ids_[cell] = id;
    });
  }
}

}  // namespace madori::localization
