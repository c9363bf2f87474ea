#include "mapping/drawing/raster/dash_ends.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/line_index.hpp"

namespace madori::mapping {
namespace {

constexpr double kBend = 0.3;     // radians
constexpr double kWidestGap = 9;  // dash thicknesses
constexpr double kLikeThickness = 1.6;
constexpr double kLongest = 1.6;  // in lengths of the longest dash

struct Dash {
  PixelSegment axis;
  double thickness = 1;
  double heading = 0;
  int group = 0;
};

}  // namespace

DrawnLines dash_axes(const Components& marks, const std::vector<std::vector<std::size_t>>& dashed) {
  DrawnLines axes;
  int group = 0;
  for (const auto& members : dashed) {
    for (const std::size_t i : members) {
      const Component& c = marks.all()[i];
      const double du = 0.5 * c.long_px * std::cos(c.angle_rad), dv = 0.5 * c.long_px * std::sin(c.angle_rad);
      DrawnLine axis;
      axis.segment = {c.middle_u - du, c.middle_v - dv, c.middle_u + du, c.middle_v + dv};
      axis.stroke_px = c.short_px;
      axis.chain = group;
      axes.push_back(axis);
    }
    ++group;
  }
  return axes;
}

void reject_dash_ends(DrawnLines& lines, const DrawnLines& dashes) {
  std::map<int, double> longest;
  std::vector<Dash> ends;
  for (const DrawnLine& dash : dashes) {
    longest[dash.chain] = std::max(longest[dash.chain], dash.length_px());
    ends.push_back({dash.segment, dash.stroke_px, dash.angle_rad(), dash.chain});
  }
  const LineIndex index(lines, 64);
  for (std::size_t next = 0; next < ends.size(); ++next) {
    const Dash dash = ends[next];
    const FittedLine axis = line_through(dash.axis);
    const double half = 0.5 * dash.axis.length_px(), reach = std::max(kWidestGap * dash.thickness, 12.0);
    const bool dot = 2 * half < 2 * dash.thickness;
    index.near(dash.axis, reach, [&](std::size_t j) {
      DrawnLine& line = lines[j];
      if (line.rejected || line.length_px() > kLongest * longest[dash.group]) return;
      const double thickness = line.stroke_px;
      if (std::max(thickness, dash.thickness) > kLikeThickness * std::min(thickness, dash.thickness)) return;
      if (!dot && angle_between(line.angle_rad(), dash.heading) > kBend) return;
      const PixelSegment& s = line.segment;
      const double a1 = std::abs(axis.along(s.u1, s.v1)), a2 = std::abs(axis.along(s.u2, s.v2));
      const bool first = a1 < a2;
      const double off = std::abs(first ? axis.across(s.u1, s.v1) : axis.across(s.u2, s.v2));
      const double gap = std::min(a1, a2) - half;
      if (off > dash.thickness + 2 || gap > reach || gap < (line.solid_face ? -dash.thickness : -2.0)) return;
      line.rejected = RejectReason::Dashed;
      ends.push_back({s, dash.thickness, line.angle_rad(), dash.group});
    });
  }
}

}  // namespace madori::mapping
