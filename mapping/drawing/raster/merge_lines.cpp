#include "mapping/drawing/raster/merge_lines.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/line_index.hpp"

namespace madori::mapping {
namespace {

constexpr double kCell = 64;  // pixels, of the index
// Between pieces of one line: sideways, pixels, and 2 degrees. Two faces of a wall are further apart.
constexpr double kLargestOffset = 1.5, kLargestAngle = 0.035;

/// Measured once: most lines are compared with many that run another way.
struct Measured {
  explicit Measured(const DrawnLine& line) : length_px(line.length_px()), angle_rad(line.angle_rad()) {}
  double length_px, angle_rad;
};

bool run_alike(const Measured& a, const Measured& b) {
  const double blur = kLargestOffset / std::max(1.0, std::min(a.length_px, b.length_px));
  return !(angle_between(a.angle_rad, b.angle_rad) > kLargestAngle + blur);
}

/// The line through both, which run alike, weighted by length; nothing where they are not one line.
std::optional<DrawnLine> joined(const DrawnLine& a, const DrawnLine& b, double largest_gap_px) {
  const DrawnLine& longer = a.length_px() >= b.length_px() ? a : b;
  const DrawnLine& shorter = &longer == &a ? b : a;
  const FittedLine line = line_through(longer.segment);
  const PixelSegment& s = shorter.segment;
  const double off1 = line.across(s.u1, s.v1), off2 = line.across(s.u2, s.v2);
  if (std::max(std::abs(off1), std::abs(off2)) > kLargestOffset) return std::nullopt;
  const double half = 0.5 * longer.length_px();
  const double from = std::min(line.along(s.u1, s.v1), line.along(s.u2, s.v2));
  const double to = std::max(line.along(s.u1, s.v1), line.along(s.u2, s.v2));
  if (from > half + largest_gap_px || to < -half - largest_gap_px) return std::nullopt;
  DrawnLine both = longer;
  if (from < -half || to > half) {  // the ends furthest apart carry the direction of both pieces
    const bool forward = line.along(s.u1, s.v1) < line.along(s.u2, s.v2);
    const PixelSegment turned = forward ? s : PixelSegment{s.u2, s.v2, s.u1, s.v1};
    if (from < -half) both.segment.u1 = turned.u1, both.segment.v1 = turned.v1;
    if (to > half) both.segment.u2 = turned.u2, both.segment.v2 = turned.v2;
  }
  const double length = a.length_px() + b.length_px();
  if (length > 0) both.probability = (a.probability * a.length_px() + b.probability * b.length_px()) / length;
  return both;
}

bool merge_once(DrawnLines& lines, double largest_gap_px) {
  const LineIndex index(lines, kCell);
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<Measured> measured(lines.begin(), lines.end());
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return measured[a].length_px > measured[b].length_px;
  });
  std::vector<bool> gone(lines.size(), false);
  bool changed = false;
  for (const std::size_t i : order) {
    if (gone[i]) continue;
    const PixelSegment around = lines[i].segment;
    index.near(around, largest_gap_px + 1, [&](std::size_t j) {
      if (j == i || gone[j] || gone[i] || lines[i].solid_face != lines[j].solid_face ||
          lines[i].rejected != lines[j].rejected || !run_alike(measured[i], measured[j]))
        return;
      if (const auto both = joined(lines[i], lines[j], largest_gap_px)) {
        lines[i] = *both;
        measured[i] = Measured(*both);
        gone[j] = changed = true;
      }
    });
  }
  std::size_t at = 0;
  std::erase_if(lines, [&](const DrawnLine&) { return gone[at++]; });
  return changed;
}

}  // namespace

DrawnLines merge_lines(DrawnLines lines, double largest_gap_px) {
  while (merge_once(lines, largest_gap_px)) continue;
  return lines;
}

}  // namespace madori::mapping
