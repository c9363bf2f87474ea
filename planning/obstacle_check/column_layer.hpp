#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "core/stamp.hpp"

namespace madori::planning {

/// What stands on a small square of the floor, Odom frame.
struct Column {
  std::int32_t cell_x = 0;
  std::int32_t cell_y = 0;
  float min_x_m = 0.0F, max_x_m = 0.0F, min_y_m = 0.0F, max_y_m = 0.0F;
  float low_m = 0.0F, high_m = 0.0F;  ///< above the floor
  float top_m = 0.0F;         ///< as high as two points of one scan reached, there or beside it: no stray one
  std::int16_t hits = 0;      ///< points of the last scan that saw it
  std::int16_t misses = 0;    ///< scans in a row that should have seen it and did not
  bool confirmed = false;     ///< no stray point
  bool part_of_tall = false;  ///< stood beside something high: the foot of a person, not a body on the floor
  bool came = false;          ///< was seen to come there, some time
  bool entered = false;       ///< stands where the floor was seen empty a moment ago
  Stamp seen{};               ///< last
  Stamp since{};              ///< first, without a gap
  Stamp under{};              ///< when something higher than the vehicle was last seen above it
  float hidden_x_m = 0.0F, hidden_y_m = 0.0F;  ///< so far it may go on below the lowest beam, Odom axes

  [[nodiscard]] Point2<Odom> centre() const {
    return {0.5 * (static_cast<double>(min_x_m) + static_cast<double>(max_x_m)),
            0.5 * (static_cast<double>(min_y_m) + static_cast<double>(max_y_m))};
  }
  void widen(const Point2<Odom>& place) {
    const auto x = static_cast<float>(place.x_m), y = static_cast<float>(place.y_m);
    min_x_m = std::min(min_x_m, x), max_x_m = std::max(max_x_m, x);
    min_y_m = std::min(min_y_m, y), max_y_m = std::max(max_y_m, y);
  }
  [[nodiscard]] bool has_hidden_part() const { return hidden_x_m != 0.0F || hidden_y_m != 0.0F; }
  /// A place of its hidden part, `away_m` from the middle.
  [[nodiscard]] Point2<Odom> hidden_at(double away_m) const {
    const double x = hidden_x_m, y = hidden_y_m, share = away_m / std::hypot(x, y);
    return {centre().x_m + share * x, centre().y_m + share * y};
  }
  friend bool operator==(const Column&, const Column&) = default;
};

/// Order of rows, then columns.
[[nodiscard]] inline bool by_cell(const Column& a, const Column& b) {
  return a.cell_y != b.cell_y ? a.cell_y < b.cell_y : a.cell_x < b.cell_x;
}

/// The points of one scan by the squares of the floor that they stand on, in a window around a place.
class ColumnLayer {
 public:
  void begin(const Point2<Odom>& centre, double reach_m, double cell_m, Stamp stamp);
  /// Points outside the window are left out.
  void add(const Point2<Odom>& place, double height_m);
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  /// The column of a cell, or nothing.
  [[nodiscard]] const Column* find(std::int32_t cell_x, std::int32_t cell_y) const;
  /// Counts the points of neighbouring cells, tells how high they reach, and looks for something higher than
  /// `tall_m` beside each. Points of what `stood` there before tell nothing of what is new beside it: a stray
  /// point before a wall is no more than a stray point.
  void confirm(int fewest_points, double tall_m, const ColumnLayer& stood);

 private:
  [[nodiscard]] bool holds(std::int32_t x, std::int32_t y) const {
    return x >= x0_ && y >= y0_ && x < x0_ + side_ && y < y0_ + side_;
  }
  [[nodiscard]] std::size_t index(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y - y0_) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(x - x0_);
  }

  std::int32_t x0_ = 0, y0_ = 0, side_ = 0;
  double cell_m_ = 0.1;
  Stamp stamp_{};
  std::vector<Column> columns_;
  std::vector<std::int32_t> slots_;  ///< cell of the window to column, -1 where empty
  std::vector<float> second_m_;      ///< of each column: its second highest point
};

}  // namespace madori::planning
