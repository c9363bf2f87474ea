#include "planning/obstacle_check/column_layer.hpp"

#include <algorithm>
#include <limits>

namespace madori::planning {
namespace {

constexpr float kNone = std::numeric_limits<float>::lowest();

/// The two highest of what it is told.
struct Highest {
  float first_m = kNone, second_m = kNone;
  void take(float height_m) {
    second_m = std::max(second_m, std::min(first_m, height_m));
    first_m = std::max(first_m, height_m);
  }
};

void widen(Column& c, float x, float y, float height) {
  c.min_x_m = std::min(c.min_x_m, x);
  c.max_x_m = std::max(c.max_x_m, x);
  c.min_y_m = std::min(c.min_y_m, y);
  c.max_y_m = std::max(c.max_y_m, y);
  c.low_m = std::min(c.low_m, height);
  c.high_m = std::max(c.high_m, height);
  if (c.hits < 1000) ++c.hits;
}

}  // namespace

void ColumnLayer::begin(const Point2<Odom>& centre, double reach_m, double cell_m, Stamp stamp) {
  const auto half = static_cast<std::int32_t>(std::ceil(reach_m / cell_m));
  x0_ = static_cast<std::int32_t>(std::floor(centre.x_m / cell_m)) - half;
  y0_ = static_cast<std::int32_t>(std::floor(centre.y_m / cell_m)) - half;
  side_ = 2 * half + 1;
  cell_m_ = cell_m;
  stamp_ = stamp;
  columns_.clear();
  second_m_.clear();
  slots_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), -1);
}

void ColumnLayer::add(const Point2<Odom>& place, double height_m) {
  const auto cx = static_cast<std::int32_t>(std::floor(place.x_m / cell_m_));
  const auto cy = static_cast<std::int32_t>(std::floor(place.y_m / cell_m_));
  if (!holds(cx, cy)) return;
  const auto x = static_cast<float>(place.x_m);
  const auto y = static_cast<float>(place.y_m);
  const auto height = static_cast<float>(height_m);
  std::int32_t& slot = slots_[index(cx, cy)];
  if (slot >= 0) {
    Column& column = columns_[static_cast<std::size_t>(slot)];
    float& second_m = second_m_[static_cast<std::size_t>(slot)];
    second_m = std::max(second_m, std::min(column.high_m, height));
    return widen(column, x, y, height);
  }
  slot = static_cast<std::int32_t>(columns_.size());
  Column column{cx, cy, x, x, y, y, height, height, height, 1};
  column.seen = column.since = stamp_;
  columns_.push_back(column);
  second_m_.push_back(kNone);
}

const Column* ColumnLayer::find(std::int32_t cell_x, std::int32_t cell_y) const {
  const std::int32_t slot = holds(cell_x, cell_y) ? slots_[index(cell_x, cell_y)] : -1;
  return slot < 0 ? nullptr : &columns_[static_cast<std::size_t>(slot)];
}

void ColumnLayer::confirm(int fewest_points, double tall_m, const ColumnLayer& stood) {
  const auto stood_at = [&](const Column& c) { return stood.find(c.cell_x, c.cell_y) != nullptr; };
  for (Column& column : columns_) {
    const bool is_new = !stood_at(column);
    int points = 0;
    bool tall = false;
    Highest highest;
    for (std::int32_t dy = -3; dy <= 3; ++dy)
      for (std::int32_t dx = -3; dx <= 3; ++dx) {
        const Column* neighbour = find(column.cell_x + dx, column.cell_y + dy);
        if (neighbour == nullptr) continue;
        if (std::abs(dx) <= 1 && std::abs(dy) <= 1) {
          if (!is_new || !stood_at(*neighbour)) points += neighbour->hits;
          highest.take(neighbour->high_m);
          highest.take(second_m_[static_cast<std::size_t>(neighbour - columns_.data())]);
        }
        tall = tall || static_cast<double>(neighbour->high_m) > tall_m;
      }
    column.top_m = points > 1 ? highest.second_m : column.high_m;
    column.confirmed = points >= fewest_points;
    column.part_of_tall = tall;
  }
}

}  // namespace madori::planning
