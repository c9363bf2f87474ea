#include "mapping/wall_map/grid_frame.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

constexpr double kMostCells = 4e8;

/// The cells whose centres lie in [low, high], both counted from the grid's edge in cells.
CellSpan clipped(double low, double high, int count) {
  const double first = std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(count));
  const double last = std::clamp(std::floor(high - 0.5) + 1.0, first, static_cast<double>(count));
  return {static_cast<int>(first), static_cast<int>(last)};
}

}  // namespace

GridFrame GridFrame::around(const Walls& walls, double margin_m, double cell_m) {
  if (walls.empty()) return {{0.0, 0.0}, cell_m, 1, 1};
  Point2<Map> low = walls.front().segment.a;
  Point2<Map> high = low;
  for (const Wall& wall : walls)
    for (const Point2<Map>& p : {wall.segment.a, wall.segment.b}) {
      low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
      high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
    }
  const double width = std::floor((high.x_m - low.x_m + 2.0 * margin_m) / cell_m) + 1.0;
  const double height = std::floor((high.y_m - low.y_m + 2.0 * margin_m) / cell_m) + 1.0;
  if (!(width * height <= kMostCells))
    throw Error("wall map",
                "covers " + std::to_string(width * cell_m) + " m x " + std::to_string(height * cell_m) +
                    " m, too large for its tables",
                "check the scale of the drawing: madori scale");
  return {
      {low.x_m - margin_m, low.y_m - margin_m}, cell_m, static_cast<int>(width), static_cast<int>(height)};
}

CellSpan rows_near(const GridFrame& frame, const Segment2<Map>& s, double radius_m) {
  const auto [low, high] = std::minmax({s.a.y_m, s.b.y_m});
  return clipped((low - radius_m - frame.origin.y_m) / frame.cell_m,
                 (high + radius_m - frame.origin.y_m) / frame.cell_m, frame.height);
}

CellSpan cells_near(const GridFrame& frame, const Segment2<Map>& s, double radius_m, int row) {
  const double y = frame.centre(0, row).y_m;
  double t_low = 0.0;
  double t_high = 1.0;
  const double dy = s.b.y_m - s.a.y_m;
  if (std::abs(dy) > 1e-12) {  // only this stretch of the wall is within the radius of the row
    const double t1 = (y - radius_m - s.a.y_m) / dy;
    const double t2 = (y + radius_m - s.a.y_m) / dy;
    t_low = std::max(0.0, std::min(t1, t2));
    t_high = std::min(1.0, std::max(t1, t2));
    if (t_low > t_high) return {};
  }
  const double dx = s.b.x_m - s.a.x_m;
  const auto [low, high] = std::minmax({s.a.x_m + t_low * dx, s.a.x_m + t_high * dx});
  return clipped((low - radius_m - frame.origin.x_m) / frame.cell_m,
                 (high + radius_m - frame.origin.x_m) / frame.cell_m, frame.width);
}

}  // namespace madori::mapping
