#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "planning/obstacle_check/obstacle_field.hpp"

namespace madori::planning {

/// Groups of columns that came where nothing was, and touch, with a gap of one cell allowed; by flooding over
/// a grid of the cells between the outermost columns. What a person stands beside is no part of the group.
/// One scan after the other, in memory that it uses again.
class ColumnGroups {
 public:
  struct Group {
    Point2<Odom> centre;
    double radius_m = 0.0;
    double high_m = 0.0;  ///< above the floor
  };

  /// Those of the columns of a scan, sorted by rows, that are no wider than `widest_m`. Good until the next
  /// call.
  const std::vector<Group>& find(const std::vector<Column>& columns, Stamp stamp, double widest_m);

 private:
  void lay_out(const std::vector<Column>& columns, Stamp stamp);
  /// The columns that touch one another and the first become members_.
  void flood(const std::vector<Column>& columns, std::size_t first);
  void take(std::int32_t x, std::int32_t y);
  [[nodiscard]] std::size_t slot(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y - y0_) * static_cast<std::size_t>(x1_ - x0_ + 1) +
           static_cast<std::size_t>(x - x0_);
  }
  [[nodiscard]] std::optional<Group> compact(const std::vector<Column>& columns, double widest_m) const;

  std::vector<bool> taken_;
  std::int32_t x0_ = 0, x1_ = 0, y0_ = 0, y1_ = 0;  ///< the outermost cells
  std::vector<std::int32_t> slots_;                 ///< column of each cell, -1 where there is none
  std::vector<std::size_t> members_;
  std::vector<Group> found_;
};

}  // namespace madori::planning
