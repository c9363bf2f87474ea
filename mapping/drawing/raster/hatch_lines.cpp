#include "mapping/drawing/raster/hatch_lines.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/line_index.hpp"

namespace madori::mapping {
namespace {

constexpr double kParallel = 0.06;  // radians
constexpr double kLikeLength = 0.6;
constexpr double kLikeOverlap = 0.6;
constexpr double kEven = 0.25;          // between neighbouring distances
constexpr double kCloseTogether = 0.5;  // distance over length
constexpr int kFewestLines = 4;

struct Beside {
  std::size_t line = 0;
  double distance = 0;
};

/// The nearest like line on one side of a line.
std::optional<Beside> beside(std::size_t self, const DrawnLines& lines, const LineIndex& index, bool left) {
  const DrawnLine& own = lines[self];
  const FittedLine axis = line_through(own.segment);
  const double length = own.length_px(), reach = kCloseTogether * length;
  std::optional<Beside> best;
  index.near(axis.middle_u, axis.middle_v, reach, [&](std::size_t j) {
    if (j == self || angle_between(own.angle_rad(), lines[j].angle_rad()) > kParallel) return;
    const PixelSegment& s = lines[j].segment;
    const double off = axis.across(0.5 * (s.u1 + s.u2), 0.5 * (s.v1 + s.v2));
    if ((off < 0) != left || std::abs(off) < 2 || std::abs(off) > reach) return;
    const double a = axis.along(s.u1, s.v1), b = axis.along(s.u2, s.v2);
    const double overlap = std::min(std::max(a, b), 0.5 * length) - std::max(std::min(a, b), -0.5 * length);
    if (overlap < kLikeOverlap * std::min(length, lines[j].length_px())) return;
    if (!best || std::abs(off) < best->distance) best = Beside{j, std::abs(off)};
  });
  if (!best) return best;
  const double other = lines[best->line].length_px();
  return std::min(other, length) >= kLikeLength * std::max(other, length) ? best : std::nullopt;
}

}  // namespace

void reject_hatch(DrawnLines& lines, const std::vector<Evidence>& evidence) {
  const LineIndex index(lines, 64);
  std::vector<bool> seen(lines.size(), false), hatch(lines.size(), false);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (seen[i] || lines[i].rejected) continue;
    for (const bool left : {false, true}) {
      std::vector<std::size_t> family{i};
      double distance = 0;
      bool side = left;
      while (const auto next = beside(family.back(), lines, index, side)) {
        if (family.size() > 1 && std::abs(next->distance - distance) > std::max(1.5, kEven * distance)) break;
        distance = family.size() > 1 ? 0.5 * (distance + next->distance) : next->distance;
        if (std::find(family.begin(), family.end(), next->line) != family.end()) break;
        const PixelSegment &a = lines[family.back()].segment, &b = lines[next->line].segment;
        if ((a.u2 - a.u1) * (b.u2 - b.u1) + (a.v2 - a.v1) * (b.v2 - b.v1) < 0) side = !side;
        family.push_back(next->line);
      }
      if (static_cast<int>(family.size()) < kFewestLines) continue;
      for (const std::size_t member : family) hatch[member] = seen[member] = true;
    }
  }
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (hatch[i] && !lines[i].rejected && evidence[i].filled_px < 0.5 * lines[i].length_px())
      lines[i].rejected = RejectReason::Hatch;
}

}  // namespace madori::mapping
