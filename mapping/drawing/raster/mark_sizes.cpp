#include "mapping/drawing/raster/mark_sizes.hpp"

#include <algorithm>
#include <cmath>

namespace madori::mapping {
namespace {

constexpr double kSmallInWalls = 14;  // wall thicknesses
constexpr double kSmallShare = 0.07;  // of the dominating mark
constexpr double kDominates = 0.5;    // of the box around all marks
constexpr double kRectangle = 0.9;    // fill of a solid column

int mark_near(const Components& marks, double u, double v) {
  for (const int reach : {0, 1, 2})
    for (int dv = -reach; dv <= reach; ++dv)
      for (int du = -reach; du <= reach; ++du)
        if (const int mark = marks.at(static_cast<int>(u) + du, static_cast<int>(v) + dv); mark >= 0)
          return mark;
  return -1;
}

int mark_of(const DrawnLine& line, const Components& marks) {
  for (const double t : {0.5, 0.25, 0.75, 0.1, 0.9})
    if (const int mark = mark_near(marks, std::lerp(line.segment.u1, line.segment.u2, t),
                                   std::lerp(line.segment.v1, line.segment.v2, t));
        mark >= 0)
      return mark;
  return -1;
}

}  // namespace

std::vector<bool> on_small_marks(const DrawnLines& lines, const Components& marks, const WallStyle& style) {
  std::vector<bool> small(lines.size(), false);
  if (marks.all().empty()) return small;
  int left = 1 << 30, top = 1 << 30, right = 0, bottom = 0, largest = 0;
  for (const Component& c : marks.all()) {
    left = std::min(left, c.left);
    top = std::min(top, c.top);
    right = std::max(right, c.right);
    bottom = std::max(bottom, c.bottom);
    largest = std::max(largest, c.size());
  }
  if (largest < kDominates * std::max(right - left, bottom - top)) return small;
  const double limit = std::max(kSmallInWalls * style.thickness_px, kSmallShare * largest);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const int mark = mark_of(lines[i], marks);
    if (mark < 0) continue;
    const Component& c = marks.all()[static_cast<std::size_t>(mark)];
    const bool bar = c.short_px < 2.2 * style.thickness_px && c.long_px > 2.2 * c.short_px;
    const bool column = c.fill() > kRectangle && c.short_px > 0.8 * style.thickness_px;
    small[i] = c.size() < limit && !bar && !column;
  }
  return small;
}

}  // namespace madori::mapping
