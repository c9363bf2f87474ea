#include "planning/obstacle_check/column_groups.hpp"

#include <algorithm>

namespace madori::planning {

void ColumnGroups::lay_out(const std::vector<Column>& columns, Stamp stamp) {
  x0_ = x1_ = columns.front().cell_x;
  for (const Column& c : columns) {
    x0_ = std::min(x0_, c.cell_x);
    x1_ = std::max(x1_, c.cell_x);
  }
  y0_ = columns.front().cell_y;  // they are sorted by rows
  y1_ = columns.back().cell_y;
  const auto rows = static_cast<std::size_t>(y1_ - y0_) + 1;
  slots_.assign(rows * (static_cast<std::size_t>(x1_ - x0_) + 1), -1);
  taken_.assign(columns.size(), false);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    taken_[i] = !(columns[i].confirmed && columns[i].entered && columns[i].seen == stamp);
    slots_[slot(columns[i].cell_x, columns[i].cell_y)] = static_cast<std::int32_t>(i);
  }
}

const std::vector<ColumnGroups::Group>& ColumnGroups::find(const std::vector<Column>& columns, Stamp stamp,
                                                           double widest_m) {
  found_.clear();
  if (columns.empty()) return found_;
  lay_out(columns, stamp);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (taken_[i]) continue;
    flood(columns, i);
    if (const auto group = compact(columns, widest_m)) found_.push_back(*group);
  }
  return found_;
}

void ColumnGroups::flood(const std::vector<Column>& columns, std::size_t first) {
  members_.assign(1, first);
  taken_[first] = true;
  for (std::size_t next = 0; next < members_.size(); ++next) {
    const Column& column = columns[members_[next]];
    for (std::int32_t dy = -2; dy <= 2; ++dy)
      for (std::int32_t dx = -2; dx <= 2; ++dx) take(column.cell_x + dx, column.cell_y + dy);
  }
}

void ColumnGroups::take(std::int32_t x, std::int32_t y) {
  if (x < x0_ || x > x1_ || y < y0_ || y > y1_) return;
  const std::int32_t found = slots_[slot(x, y)];
  if (found < 0) return;
  const auto index = static_cast<std::size_t>(found);
  if (taken_[index]) return;
  taken_[index] = true;
  members_.push_back(index);
}

std::optional<ColumnGroups::Group> ColumnGroups::compact(const std::vector<Column>& columns,
                                                         double widest_m) const {
  Column box = columns[members_.front()];
  for (const std::size_t i : members_) {
    box.min_x_m = std::min(box.min_x_m, columns[i].min_x_m);
    box.max_x_m = std::max(box.max_x_m, columns[i].max_x_m);
    box.min_y_m = std::min(box.min_y_m, columns[i].min_y_m);
    box.max_y_m = std::max(box.max_y_m, columns[i].max_y_m);
    box.high_m = std::max(box.high_m, columns[i].high_m);
  }
  const double width_m = static_cast<double>(std::max(box.max_x_m - box.min_x_m, box.max_y_m - box.min_y_m));
  if (width_m > widest_m) return std::nullopt;
  return Group{{0.5 * static_cast<double>(box.min_x_m + box.max_x_m),
                0.5 * static_cast<double>(box.min_y_m + box.max_y_m)},
               std::max(0.1, width_m / 2.0),
               static_cast<double>(box.high_m)};
}

}  // namespace madori::planning
