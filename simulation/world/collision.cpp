#include "simulation/world/collision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace madori::simulation {
namespace {

constexpr double kCellM = 2.0;
using Outline = std::vector<Point2<Building>>;

struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Span project(const Outline& outline, double nx, double ny) {
  Span span;
  for (const auto& p : outline) {
    const double at = p.x_m * nx + p.y_m * ny;
    span.low = std::min(span.low, at);
    span.high = std::max(span.high, at);
  }
  return span;
}

bool apart(const Outline& a, const Outline& b, double nx, double ny) {
  const Span sa = project(a, nx, ny), sb = project(b, nx, ny);
  return sa.high < sb.low || sb.high < sa.low;
}

/// Whether a normal of an edge of `edges` separates the two. A wall of two corners has its own direction as
/// a second axis: its ends.
bool separated_by(const Outline& edges, const Outline& a, const Outline& b) {
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& p = edges[i];
    const auto& q = edges[(i + 1) % edges.size()];
    const double ex = q.x_m - p.x_m, ey = q.y_m - p.y_m;
    if (apart(a, b, -ey, ex)) return true;
    if (edges.size() == 2 && apart(a, b, ex, ey)) return true;
  }
  return false;
}

struct CellRange {
  std::int32_t x0, y0, x1, y1;
};

CellRange cells_of(const Outline& outline) {
  const Span x = project(outline, 1.0, 0.0), y = project(outline, 0.0, 1.0);
  const auto cell = [](double at) { return static_cast<std::int32_t>(std::floor(at / kCellM)); };
  return {cell(x.low), cell(y.low), cell(x.high), cell(y.high)};
}

std::uint64_t key(std::int32_t x, std::int32_t y) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32U) | static_cast<std::uint32_t>(y);
}

}  // namespace

bool overlap(const Outline& a, const Outline& b) {
  if (apart(a, b, 1.0, 0.0) || apart(a, b, 0.0, 1.0)) return false;
  return !separated_by(a, a, b) && !separated_by(b, a, b);
}

void ObstacleIndex::add(Obstacle obstacle) {
  const CellRange range = cells_of(obstacle.outline);
  for (std::int32_t x = range.x0; x <= range.x1; ++x)
    for (std::int32_t y = range.y0; y <= range.y1; ++y)
      cells_[key(x, y)].push_back(static_cast<std::uint32_t>(obstacles_.size()));
  obstacles_.push_back(std::move(obstacle));
}

const Obstacle* ObstacleIndex::find(const Outline& outline, const HeightRange& z) const {
  const CellRange range = cells_of(outline);
  std::uint32_t best = std::numeric_limits<std::uint32_t>::max();
  for (std::int32_t x = range.x0; x <= range.x1; ++x) {
    for (std::int32_t y = range.y0; y <= range.y1; ++y) {
      const auto cell = cells_.find(key(x, y));
      if (cell == cells_.end()) continue;
      for (const std::uint32_t i : cell->second) {
        const Obstacle& o = obstacles_[i];
        if (i < best && o.z.low_m < z.high_m && o.z.high_m > z.low_m && overlap(outline, o.outline)) best = i;
      }
    }
  }
  return best == std::numeric_limits<std::uint32_t>::max() ? nullptr : &obstacles_[best];
}

}  // namespace madori::simulation
