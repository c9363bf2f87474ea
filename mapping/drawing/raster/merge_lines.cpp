#include "mapping/drawing/raster/merge_lines.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/line_index.hpp"

namespace madori::mapping {
namespace {

constexpr double kCell = 64;
constexpr int kMostRounds = 6;

/// The line through both, weighted by length; nothing where they are not one line.
std::optional<DrawnLine> joined(const DrawnLine& a, const DrawnLine& b, const MergeOptions& options) {
  const DrawnLine& longer = a.length_px() >= b.length_px() ? a : b;
  const DrawnLine& shorter = &longer == &a ? b : a;
  const double blur = options.largest_offset_px / std::max(1.0, shorter.length_px());
  if (angle_between(a.angle_rad(), b.angle_rad()) > options.largest_angle_rad + blur) return std::nullopt;
  const FittedLine line = line_through(longer.segment);
  const PixelSegment& s = shorter.segment;
  const double off1 = line.across(s.u1, s.v1), off2 = line.across(s.u2, s.v2);
  if (std::max(std::abs(off1), std::abs(off2)) > options.largest_offset_px) return std::nullopt;
  const double half = 0.5 * longer.length_px();
  const double from = std::min(line.along(s.u1, s.v1), line.along(s.u2, s.v2));
  const double to = std::max(line.along(s.u1, s.v1), line.along(s.u2, s.v2));
  if (from > half + options.largest_gap_px || to < -half - options.largest_gap_px) return std::nullopt;
  const PixelSegment& l = longer.segment;
  DrawnLine both = longer;
  if (from < -half || to > half) {  // the ends furthest apart carry the direction of both pieces
    const bool forward = line.along(s.u1, s.v1) < line.along(s.u2, s.v2);
    const LinePoint low = forward ? LinePoint{s.u1, s.v1} : LinePoint{s.u2, s.v2};
    const LinePoint high = forward ? LinePoint{s.u2, s.v2} : LinePoint{s.u1, s.v1};
    const LinePoint start = from < -half ? low : LinePoint{l.u1, l.v1};
    const LinePoint end = to > half ? high : LinePoint{l.u2, l.v2};
    both.segment = {start.u, start.v, end.u, end.v};
  }
  const double length = a.length_px() + b.length_px();
  if (length > 0) both.probability = (a.probability * a.length_px() + b.probability * b.length_px()) / length;
  return both;
}

bool merge_once(DrawnLines& lines, const MergeOptions& options) {
  const LineIndex index(lines, kCell);
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return lines[a].length_px() > lines[b].length_px(); });
  std::vector<bool> gone(lines.size(), false);
  bool changed = false;
  for (const std::size_t i : order) {
    if (gone[i]) continue;
    const PixelSegment around = lines[i].segment;
    index.near(around, options.largest_gap_px + 1, [&](std::size_t j) {
      if (j == i || gone[j] || gone[i] || lines[i].solid_face != lines[j].solid_face ||
          lines[i].rejected != lines[j].rejected)
        return;
      if (const auto both = joined(lines[i], lines[j], options)) {
        lines[i] = *both;
        gone[j] = changed = true;
      }
    });
  }
  std::size_t at = 0;
  std::erase_if(lines, [&](const DrawnLine&) { return gone[at++]; });
  return changed;
}

}  // namespace

DrawnLines merge_lines(DrawnLines lines, const MergeOptions& options) {
  for (int round = 0; round < kMostRounds && merge_once(lines, options); ++round) {
  }
  return lines;
}

}  // namespace madori::mapping
