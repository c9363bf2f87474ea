#include "mapping/drawing/raster/sheet_frame.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/line_index.hpp"

namespace madori::mapping {
namespace {

constexpr double kLeastSpan = 0.5;     // of the drawing's larger side
constexpr double kBeyondShare = 0.01;  // of the line length of the drawing
constexpr double kLeastAttached = 3;   // inner walls that make a line the outline of a building
constexpr double kLeastRest = 0.5;     // wall-like length beside the candidates, in lengths of the candidates

double extent_of(const DrawnLines& lines) {
  double left = 1e18, top = 1e18, right = 0, bottom = 0;
  for (const DrawnLine& line : lines) {
    const PixelSegment& s = line.segment;
    left = std::min({left, s.u1, s.u2});
    top = std::min({top, s.v1, s.v2});
    right = std::max({right, s.u1, s.u2});
    bottom = std::max({bottom, s.v1, s.v2});
  }
  return std::max(right - left, bottom - top);
}

bool nothing_beyond(const DrawnLines& lines, const FittedLine& axis, double margin) {
  double left = 0, right = 0, all = 0;
  for (const DrawnLine& line : lines) {
    const PixelSegment& s = line.segment;
    const double off = axis.across(0.5 * (s.u1 + s.u2), 0.5 * (s.v1 + s.v2));
    all += line.length_px();
    if (off > margin) right += line.length_px();
    if (off < -margin) left += line.length_px();
  }
  return std::min(left, right) <= kBeyondShare * all;
}

int attached(std::size_t self, const DrawnLines& lines, const std::vector<Evidence>& evidence,
             const LineIndex& index, const WallStyle& style) {
  const FittedLine axis = line_through(lines[self].segment);
  const double half = 0.5 * lines[self].length_px(), reach = style.thickness_px;
  int count = 0;
  index.near(lines[self].segment, reach, [&](std::size_t j) {
    if (j == self || lines[j].rejected || evidence[j].paired_px < 0.3 * lines[j].length_px()) return;
    if (angle_between(lines[self].angle_rad(), lines[j].angle_rad()) < 0.3) return;
    const PixelSegment& s = lines[j].segment;
    for (const LinePoint end : {LinePoint{s.u1, s.v1}, LinePoint{s.u2, s.v2}})
      if (std::abs(axis.across(end.u, end.v)) < reach && std::abs(axis.along(end.u, end.v)) < half - reach)
        ++count;
  });
  return count;
}

}  // namespace

void reject_frame(DrawnLines& lines, const std::vector<Evidence>& evidence, const WallStyle& style) {
  const double extent = extent_of(lines);
  const LineIndex index(lines, 64);
  std::vector<std::size_t> frame;
  double frame_length = 0, walls = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double length = lines[i].length_px();
    const bool single = evidence[i].paired_px < 0.3 * length;
    if (!single && !lines[i].rejected) walls += length;
    if (!single || length < kLeastSpan * extent) continue;
    if (!nothing_beyond(lines, line_through(lines[i].segment), 2 * style.thickness_px)) continue;
    if (attached(i, lines, evidence, index, style) >= kLeastAttached) continue;
    frame.push_back(i);
    frame_length += length;
  }
  if (walls < kLeastRest * frame_length) return;
  for (const std::size_t i : frame) lines[i].rejected = RejectReason::TitleBlock;
}

}  // namespace madori::mapping
