#include "mapping/drawing/raster/line_index.hpp"

#include <algorithm>
#include <cmath>

namespace madori::mapping {

LineIndex::LineIndex(const DrawnLines& lines, double cell_px) : cell_px_(cell_px), seen_(lines.size(), 0) {
  double right = 0, bottom = 0;
  for (const DrawnLine& line : lines) {
    const PixelSegment& s = line.segment;
    right = std::max({right, s.u1, s.u2});
    bottom = std::max({bottom, s.v1, s.v2});
  }
  size_ = {static_cast<int>(right / cell_px) + 1, static_cast<int>(bottom / cell_px) + 1};
  cells_.resize(static_cast<std::size_t>(size_.area()));
  for (std::size_t i = 0; i < lines.size(); ++i) insert(static_cast<std::uint32_t>(i), lines[i].segment);
}

void LineIndex::insert(std::uint32_t line, const PixelSegment& s) {
  const int steps = static_cast<int>(s.length_px() / (0.5 * cell_px_)) + 1;
  std::size_t before = cells_.size();
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const int column = cell_of(std::lerp(s.u1, s.u2, t), size_.width);
    const int row = cell_of(std::lerp(s.v1, s.v2, t), size_.height);
    const auto cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.width) +
                      static_cast<std::size_t>(column);
    if (cell != before) cells_[cell].push_back(line);
    before = cell;
  }
}

}  // namespace madori::mapping
