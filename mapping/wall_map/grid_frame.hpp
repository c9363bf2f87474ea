#pragma once

#include <cstddef>
#include <cstdint>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {

/// Where the cells of a table lie on the Map: cell (column, row) covers
/// [origin + (column, row) * cell_m, origin + (column + 1, row + 1) * cell_m); rows go up, as y does.
struct GridFrame {
  Point2<Map> origin;
  double cell_m = 0.05;
  int width = 0;
  int height = 0;

  /// The smallest grid that holds every wall and a margin around; one cell for no walls.
  /// Throws Error when it would have more than 400 million cells (a drawing whose scale is wrong).
  [[nodiscard]] static GridFrame around(const Walls& walls, double margin_m, double cell_m);

  [[nodiscard]] std::size_t cells() const { return static_cast<std::size_t>(width) * height; }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * width + column;
  }
  [[nodiscard]] Point2<Map> centre(int column, int row) const {
    return {origin.x_m + (column + 0.5) * cell_m, origin.y_m + (row + 0.5) * cell_m};
  }
  /// Index of the cell that holds `p`, or -1 outside (NaN is outside).
  [[nodiscard]] std::int64_t find(const Point2<Map>& p) const {
    const double u = (p.x_m - origin.x_m) / cell_m;
    const double v = (p.y_m - origin.y_m) / cell_m;
    if (!(u >= 0.0 && v >= 0.0 && u < width && v < height)) return -1;
    return static_cast<std::int64_t>(v) * width + static_cast<std::int64_t>(u);
  }
};

/// Distance from `p` to the nearest point of `s`, squared; an empty segment is a point.
[[nodiscard]] inline double squared_distance_m2(const Segment2<Map>& s, const Point2<Map>& p) {
  const double dx = s.b.x_m - s.a.x_m;
  const double dy = s.b.y_m - s.a.y_m;
  const double px = p.x_m - s.a.x_m;
  const double py = p.y_m - s.a.y_m;
  const double length2 = dx * dx + dy * dy;
  double t = length2 > 0.0 ? (px * dx + py * dy) / length2 : 0.0;
  t = t < 0.0 ? 0.0 : (t > 1.0 ? 1.0 : t);
  const double ex = px - t * dx;
  const double ey = py - t * dy;
  return ex * ex + ey * ey;
}

/// The cells of a table row, [first, last).
struct CellSpan {
  int first = 0;
  int last = 0;
};

/// A superset of the cells of `row` whose centres lie within `radius_m` of `s`; empty where there are none.
[[nodiscard]] CellSpan cells_near(const GridFrame& frame, const Segment2<Map>& s, double radius_m, int row);
/// A superset of the rows that have such cells.
[[nodiscard]] CellSpan rows_near(const GridFrame& frame, const Segment2<Map>& s, double radius_m);

/// Calls visit(cell index, squared distance) for every cell whose centre lies within `radius_m` of `s`.
template <class Visit>
void for_each_cell_near(const GridFrame& frame, const Segment2<Map>& s, double radius_m, Visit&& visit) {
  const CellSpan rows = rows_near(frame, s, radius_m);
  for (int row = rows.first; row < rows.last; ++row) {
    const CellSpan columns = cells_near(frame, s, radius_m, row);
    for (int column = columns.first; column < columns.last; ++column) {
      const double d2 = squared_distance_m2(s, frame.centre(column, row));
      if (d2 <= radius_m * radius_m) visit(frame.index(column, row), d2);
    }
  }
}

}  // namespace madori::mapping
