#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/types.hpp>
#include <vector>

#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

/// Which lines pass near a place: a grid of square cells, each with the lines that cross it.
class LineIndex {
 public:
  LineIndex(const DrawnLines& lines, double cell_px);

  /// Calls visit(index) once for every line that may pass within `reach` of the box around a segment (and
  /// some others).
  template <class Visit>
  void near(const PixelSegment& s, double reach, Visit visit) const {
    for_cells(std::min(s.u1, s.u2) - reach, std::min(s.v1, s.v2) - reach, std::max(s.u1, s.u2) + reach,
              std::max(s.v1, s.v2) + reach, [&](const std::vector<std::uint32_t>& cell) {
                for (const std::uint32_t line : cell) {
                  if (seen_[line] == turn_) continue;
                  seen_[line] = turn_;
                  visit(std::size_t{line});
                }
              });
  }

 private:
  [[nodiscard]] int cell_of(double position, int count) const {
    return std::clamp(static_cast<int>(position / cell_px_), 0, count - 1);
  }
  template <class Visit>
  void for_cells(double u0, double v0, double u1, double v1, Visit visit) const {
    ++turn_;
    const int first = cell_of(u0, size_.width), last = cell_of(u1, size_.width),
              bottom = cell_of(v1, size_.height);
    for (int row = cell_of(v0, size_.height); row <= bottom; ++row)
      for (int column = first; column <= last; ++column)
        visit(cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.width) +
                     static_cast<std::size_t>(column)]);
  }
  void insert(std::uint32_t line, const PixelSegment& s);

  double cell_px_;
  cv::Size size_;  // in cells
  std::vector<std::vector<std::uint32_t>> cells_;
  mutable std::vector<std::uint32_t> seen_;
  mutable std::uint32_t turn_ = 0;
};

}  // namespace madori::mapping
