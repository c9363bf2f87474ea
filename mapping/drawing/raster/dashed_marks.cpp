#include "mapping/drawing/raster/dashed_marks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/median.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/line_index.hpp"

namespace madori::mapping {
namespace {

constexpr double kLeastFill = 0.72;  // a bar fills its rectangle
constexpr double kLikeThickness = 1.8;
constexpr double kWidestGap = 9;  // in bar thicknesses
constexpr double kBend = 0.25;    // radians between neighbouring dashes: dashed curves bend
constexpr double kEvenGap = 0.4;
constexpr std::size_t kFewestDashes = 4;
constexpr double kLargestShare = 0.6;  // of the length of all dashes of a line

struct Bar {
  std::size_t mark = 0;
  DrawnLine axis;
  double thickness = 1;
};

std::vector<Bar> bars_of(const Components& marks, double pen_px) {
  std::vector<Bar> bars;
  for (std::size_t i = 0; i < marks.all().size(); ++i) {
    const Component& c = marks.all()[i];
    if (c.fill() < kLeastFill || static_cast<double>(c.area_px) < pen_px * pen_px) continue;
    Bar bar{i, {}, c.short_px};
    const double du = 0.5 * c.long_px * std::cos(c.angle_rad), dv = 0.5 * c.long_px * std::sin(c.angle_rad);
    bar.axis.segment = {c.middle_u - du, c.middle_v - dv, c.middle_u + du, c.middle_v + dv};
    bars.push_back(bar);
  }
  return bars;
}

struct Link {
  std::size_t to = 0;
  double gap = 0;
};

/// The gap from the end of `a` on side `sense` to `b` if b continues a's line; negative if not. A dot has no
/// direction of its own, so the longer bar says where the line runs.
double gap_between(const Bar& a, const Bar& b, double sense) {
  if (std::max(a.thickness, b.thickness) > kLikeThickness * std::min(a.thickness, b.thickness)) return -1;
  const Bar& longer = a.axis.length_px() >= b.axis.length_px() ? a : b;
  const Bar& shorter = &longer == &a ? b : a;
  const FittedLine line = line_through(longer.axis.segment);
  const PixelSegment &sa = a.axis.segment, &sb = b.axis.segment, &ss = shorter.axis.segment;
  const double thickness = std::max(a.thickness, b.thickness);
  const double along = line.along(0.5 * (ss.u1 + ss.u2), 0.5 * (ss.v1 + ss.v2));
  const double across = line.across(0.5 * (ss.u1 + ss.u2), 0.5 * (ss.v1 + ss.v2));
  const bool dot = shorter.axis.length_px() < 2 * shorter.thickness;
  if (!dot && angle_between(longer.axis.angle_rad(), shorter.axis.angle_rad()) > kBend) return -1;
  if (std::abs(across) > 0.6 * thickness + 0.12 * shorter.axis.length_px()) return -1;
  const double gap = std::abs(along) - 0.5 * (longer.axis.length_px() + shorter.axis.length_px());
  if (gap < 0.5 || gap > kWidestGap * thickness || gap > 1.5 * longer.axis.length_px()) return -1;
  const FittedLine own = line_through(sa);
  const double side = own.along(0.5 * (sb.u1 + sb.u2), 0.5 * (sb.v1 + sb.v2));
  return side * sense > 0 ? gap : -1;
}

std::vector<Link> links_of(std::size_t self, const std::vector<Bar>& bars, const LineIndex& index) {
  std::vector<Link> links;
  for (const double sense : {-1.0, 1.0}) {
    Link best{self, 1e18};
    index.near(bars[self].axis.segment, kWidestGap * bars[self].thickness, [&](std::size_t other) {
      if (other == self) return;
      const double gap = gap_between(bars[self], bars[other], sense);
      if (gap >= 0 && gap < best.gap) best = {other, gap};
    });
    if (best.to != self) links.push_back(best);
  }
  return links;
}

bool even(std::vector<double> gaps) {
  const double typical = median_of(gaps);
  const auto like = std::count_if(gaps.begin(), gaps.end(), [&](double gap) {
    return std::abs(gap - typical) <= std::max(2.0, kEvenGap * typical);
  });
  return static_cast<double>(like) >= 0.7 * static_cast<double>(gaps.size());
}

/// A bar longer than all others together is a line that happens to end where a few dots lie.
void drop_line(std::vector<std::size_t>& members, const std::vector<Bar>& bars) {
  double all = 0;
  for (const std::size_t i : members) all += bars[i].axis.length_px();
  std::erase_if(members, [&](std::size_t i) { return bars[i].axis.length_px() > kLargestShare * all; });
}

}  // namespace

std::vector<std::vector<std::size_t>> find_dashed(const Components& marks, double pen_px) {
  const std::vector<Bar> bars = bars_of(marks, pen_px);
  DrawnLines axes;
  for (const Bar& bar : bars) axes.push_back(bar.axis);
  const LineIndex index(axes, 64);
  std::vector<std::vector<Link>> links(bars.size());
  for (std::size_t i = 0; i < bars.size(); ++i) links[i] = links_of(i, bars, index);
  std::vector<bool> seen(bars.size(), false);
  std::vector<std::vector<std::size_t>> found;
  for (std::size_t first = 0; first < bars.size(); ++first) {
    if (seen[first]) continue;
    seen[first] = true;
    std::vector<std::size_t> members{first};
    std::vector<double> gaps;
    for (std::size_t next = 0; next < members.size(); ++next)
      for (const Link& link : links[members[next]]) {
        gaps.push_back(link.gap);
        if (seen[link.to]) continue;
        seen[link.to] = true;
        members.push_back(link.to);
      }
    drop_line(members, bars);
    if (members.size() < kFewestDashes || !even(gaps)) continue;
    for (std::size_t& member : members) member = bars[member].mark;
    found.push_back(std::move(members));
  }
  return found;
}

}  // namespace madori::mapping
