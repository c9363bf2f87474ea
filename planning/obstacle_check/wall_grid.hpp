#pragma once

#include <cstdint>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::planning {

/// Drawn walls, found by place. Built once per site.
class WallGrid {
 public:
  WallGrid() = default;
  explicit WallGrid(std::vector<Segment2<Map>> walls);

  [[nodiscard]] const std::vector<Segment2<Map>>& walls() const { return walls_; }
  /// Calls `visit(segment)` for every wall that may lie within `radius_m` of `centre`, some of them
  /// repeatedly, until a call returns true. Whether one did.
  template <class Visit>
  bool any_near(const Point2<Map>& centre, double radius_m, Visit&& visit) const {
    for (std::int32_t y = row(centre.y_m - radius_m); y <= row(centre.y_m + radius_m); ++y)
      for (std::int32_t x = column(centre.x_m - radius_m); x <= column(centre.x_m + radius_m); ++x)
        for (const std::uint32_t wall : cell(x, y))
          if (visit(walls_[wall])) return true;
    return false;
  }

 private:
  struct Cell {
    const std::uint32_t* first;
    const std::uint32_t* last;
    [[nodiscard]] const std::uint32_t* begin() const { return first; }
    [[nodiscard]] const std::uint32_t* end() const { return last; }
  };
  [[nodiscard]] std::int32_t column(double x_m) const;
  [[nodiscard]] std::int32_t row(double y_m) const;
  [[nodiscard]] Cell cell(std::int32_t x, std::int32_t y) const;
  template <class Visit>
  void for_each_cell(const Segment2<Map>& wall, Visit&& visit) const;

  std::vector<Segment2<Map>> walls_;
  Point2<Map> corner_;
  double cell_m_ = 1.0;  ///< larger where a wall far off would make too many cells
  std::int32_t columns_ = 0;
  std::int32_t rows_ = 0;
  std::vector<std::uint32_t> first_;  ///< cells + 1 entries into items_
  std::vector<std::uint32_t> items_;
};

}  // namespace madori::planning
