#include "planning/obstacle_check/wall_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace madori::planning {

std::int32_t WallGrid::column(double x_m) const {
  const double at = std::floor((x_m - corner_.x_m) / cell_m_);
  return static_cast<std::int32_t>(std::clamp(at, -1.0, static_cast<double>(columns_)));
}

std::int32_t WallGrid::row(double y_m) const {
  const double at = std::floor((y_m - corner_.y_m) / cell_m_);
  return static_cast<std::int32_t>(std::clamp(at, -1.0, static_cast<double>(rows_)));
}

WallGrid::Cell WallGrid::cell(std::int32_t x, std::int32_t y) const {
  if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return {nullptr, nullptr};
  const auto at =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
  return {items_.data() + first_[at], items_.data() + first_[at + 1]};
}

/// Every cell that a wall passes, column by column. No wall lies outside the grid, but a place on one that
/// was computed may, by a rounding.
template <class Visit>
void WallGrid::for_each_cell(const Segment2<Map>& wall, Visit&& visit) const {
  const auto [x0, x1] = std::minmax({column(wall.a.x_m), column(wall.b.x_m)});
  const auto [y0, y1] = std::minmax({row(wall.a.y_m), row(wall.b.y_m)});
  if (x0 == x1 || y0 == y1) {
    for (std::int32_t y = y0; y <= y1; ++y)
      for (std::int32_t x = x0; x <= x1; ++x) visit(x, y);
    return;
  }
  const double run = wall.b.x_m - wall.a.x_m;
  for (std::int32_t x = x0; x <= x1; ++x) {
    const double left = (corner_.x_m + x * cell_m_ - wall.a.x_m) / run;
    const double right = (corner_.x_m + (x + 1) * cell_m_ - wall.a.x_m) / run;
    const auto y_at = [&](double t) {
      return wall.a.y_m + std::clamp(t, 0.0, 1.0) * (wall.b.y_m - wall.a.y_m);
    };
    const auto inside = [&](std::int32_t y) { return std::clamp(y, 0, rows_ - 1); };
    const auto [low, high] = std::minmax({inside(row(y_at(left))), inside(row(y_at(right)))});
    for (std::int32_t y = low; y <= high; ++y) visit(x, y);
  }
}

WallGrid::WallGrid(std::vector<Segment2<Map>> walls) : walls_(std::move(walls)) {
  if (walls_.empty()) return;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Point2<Map> low{kInfinity, kInfinity};
  Point2<Map> high{-kInfinity, -kInfinity};
  for (const auto& wall : walls_)
    for (const auto& p : {wall.a, wall.b}) {
      low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
      high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
    }
  corner_ = low;
  constexpr double kMostCells = 4e6;  // 16 MB
  const double width_m = high.x_m - low.x_m, height_m = high.y_m - low.y_m;
  cell_m_ =
      std::max({cell_m_, std::sqrt(width_m / kMostCells * height_m), (width_m + height_m) / kMostCells});
  columns_ = static_cast<std::int32_t>(width_m / cell_m_) + 1;
  rows_ = static_cast<std::int32_t>(height_m / cell_m_) + 1;
  first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  const auto index = [&](std::int32_t x, std::int32_t y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
  };
  for (const auto& wall : walls_) for_each_cell(wall, [&](auto x, auto y) { ++first_[index(x, y) + 1]; });
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  items_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < walls_.size(); ++i)
    for_each_cell(walls_[i], [&](auto x, auto y) { items_[next[index(x, y)]++] = i; });
}

}  // namespace madori::planning
