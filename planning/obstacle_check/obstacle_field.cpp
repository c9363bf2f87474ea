#include "planning/obstacle_check/obstacle_field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace madori::planning {
namespace {

constexpr double kViewSlackM = 0.03;

std::pair<std::int32_t, std::int32_t> cell_of(const Column& c) {
  return {c.cell_y, c.cell_x};
}

bool by_cell(const Column& a, const Column& b) {
  return cell_of(a) < cell_of(b);
}

/// A square window of cells around the vehicle.
struct Window {
  std::int32_t x0, y0, side;
  [[nodiscard]] bool holds(std::int32_t x, std::int32_t y) const {
    return x >= x0 && y >= y0 && x < x0 + side && y < y0 + side;
  }
  [[nodiscard]] std::size_t index(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(side) +
           static_cast<std::size_t>(x - x0);
  }
};

Window window_around(const Transform2<Odom, Base>& pose, const FieldOptions& options) {
  const auto half = static_cast<std::int32_t>(std::ceil(options.reach_m / options.cell_m));
  return {static_cast<std::int32_t>(std::floor(pose.x_m() / options.cell_m)) - half,
          static_cast<std::int32_t>(std::floor(pose.y_m() / options.cell_m)) - half, 2 * half + 1};
}

Column new_column(std::int32_t x, std::int32_t y, const Point2<Odom>& p, float height, Stamp stamp) {
  const auto px = static_cast<float>(p.x_m);
  const auto py = static_cast<float>(p.y_m);
  return {x, y, px, px, py, py, height, height, 1, 0, false, false, stamp, stamp};
}

void add_point(Column& c, const Point2<Odom>& p, float height) {
  const auto px = static_cast<float>(p.x_m);
  const auto py = static_cast<float>(p.y_m);
  c.min_x_m = std::min(c.min_x_m, px);
  c.max_x_m = std::max(c.max_x_m, px);
  c.min_y_m = std::min(c.min_y_m, py);
  c.max_y_m = std::max(c.max_y_m, py);
  c.low_m = std::min(c.low_m, height);
  c.high_m = std::max(c.high_m, height);
  if (c.hits < 1000) ++c.hits;
}

Point2<Odom> centre(const Column& c) {
  return {0.5 * (static_cast<double>(c.min_x_m) + static_cast<double>(c.max_x_m)),
          0.5 * (static_cast<double>(c.min_y_m) + static_cast<double>(c.max_y_m))};
}

/// Counts the points of neighbouring cells, and looks for something tall beside what is low. `slots` tells
/// the column of each cell of the window, -1 where there is none.
void confirm(std::vector<Column>& columns, const std::vector<std::int32_t>& slots, const Window& window,
             const FieldOptions& options) {
  for (Column& column : columns) {
    int points = 0;
    bool tall = false;
    for (std::int32_t dy = -3; dy <= 3; ++dy)
      for (std::int32_t dx = -3; dx <= 3; ++dx) {
        const std::int32_t x = column.cell_x + dx;
        const std::int32_t y = column.cell_y + dy;
        const std::int32_t other = window.holds(x, y) ? slots[window.index(x, y)] : -1;
        if (other < 0) continue;
        const Column& neighbour = columns[static_cast<std::size_t>(other)];
        if (std::abs(dx) <= 1 && std::abs(dy) <= 1) points += neighbour.hits;
        tall = tall || static_cast<double>(neighbour.high_m) > options.tall_m;
      }
    column.confirmed = points >= options.fewest_points;
    column.part_of_tall = tall;
  }
}

}  // namespace

bool SensorView::sees(const Point2<Base>& place, double low_m, double high_m) const {
  const double away_m = std::hypot(place.x_m - x_m, place.y_m - y_m);
  return high_m >= z_m + away_m * std::tan(min_elevation_rad) + kViewSlackM &&
         low_m <= z_m + away_m * std::tan(max_elevation_rad);
}

std::vector<Column> ObstacleField::columns_of(const PointCloud<Base>& scan, const SensorView& view,
                                              const Transform2<Odom, Base>& odom_from_base) {
  const Window window = window_around(odom_from_base, options_);
  scratch_.assign(static_cast<std::size_t>(window.side) * static_cast<std::size_t>(window.side), -1);
  std::vector<Column> found;
  const double self_square = options_.self_reach_m * options_.self_reach_m;
  const double reach_square = options_.reach_m * options_.reach_m;
  for (const CloudPoint& p : scan.points) {
    const auto x = static_cast<double>(p.x_m);
    const auto y = static_cast<double>(p.y_m);
    if (!(x * x + y * y < reach_square)) continue;
    const double height = ground_.height_of(p);
    if (!(height > options_.ground_clearance_m) || !(height < options_.top_m)) continue;
    if ((x - view.x_m) * (x - view.x_m) + (y - view.y_m) * (y - view.y_m) < self_square) continue;
    const Point2<Odom> place = odom_from_base * Point2<Base>{x, y};
    const auto cx = static_cast<std::int32_t>(std::floor(place.x_m / options_.cell_m));
    const auto cy = static_cast<std::int32_t>(std::floor(place.y_m / options_.cell_m));
    if (!window.holds(cx, cy)) continue;
    std::int32_t& slot = scratch_[window.index(cx, cy)];
    if (slot >= 0) {
      add_point(found[static_cast<std::size_t>(slot)], place, static_cast<float>(height));
    } else {
      slot = static_cast<std::int32_t>(found.size());
      found.push_back(new_column(cx, cy, place, static_cast<float>(height), scan.stamp));
    }
  }
  confirm(found, scratch_, window, options_);
  std::sort(found.begin(), found.end(), by_cell);
  return found;
}

bool ObstacleField::keep(Column& old, const SensorView& view, const Transform2<Odom, Base>& odom_from_base,
                         Stamp now) const {
  const Point2<Base> place = odom_from_base.inverse() * centre(old);
  if (std::hypot(place.x_m, place.y_m) > options_.reach_m) return false;
  if (view.sees(place, static_cast<double>(old.low_m), static_cast<double>(old.high_m))) {
    ++old.misses;
    return old.confirmed && old.misses < options_.misses_to_forget;
  }
  if (!old.confirmed) return false;
  return !old.part_of_tall || to_seconds(now - old.seen) <= options_.foot_memory_s;
}

void ObstacleField::update(const PointCloud<Base>& scan, const SensorView& view,
                           const Transform2<Odom, Base>& odom_from_base) {
  const bool sees_floor = view.min_elevation_rad < 0.0;
  if (sees_floor) ground_ = fit_ground(scan.points, options_.ground);
  const std::vector<Column> seen = columns_of(scan, view, odom_from_base);
  std::vector<Column> merged;
  merged.reserve(seen.size() + columns_.size());
  auto fresh = seen.begin();
  for (Column& old : columns_) {
    while (fresh != seen.end() && by_cell(*fresh, old)) merged.push_back(*fresh++);
    if (fresh != seen.end() && cell_of(*fresh) == cell_of(old)) {
      Column both = *fresh++;
      both.confirmed = true;  // seen twice in one place
      both.since = old.since;
      both.high_m = std::max(both.high_m, old.high_m);
      both.low_m = std::min(both.low_m, old.low_m);
      merged.push_back(both);
    } else if (keep(old, view, odom_from_base, scan.stamp)) {
      merged.push_back(old);
    }
  }
  merged.insert(merged.end(), fresh, seen.end());
  columns_ = std::move(merged);
}

}  // namespace madori::planning
