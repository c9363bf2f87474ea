#include "localization/drawing_fit/wall_index.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace madori::localization {
namespace {

constexpr double kCellM = 0.1;
constexpr double kHalfWidthRad = to_rad(30.0);
constexpr double kBinRad = kPi / WallIndex::kDirections;

/// Of two undirected lines.
double angle_between(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, kPi));
}

}  // namespace

WallIndex::WallIndex(const mapping::Walls& walls)
    : walls_(walls), frame_(mapping::GridFrame::around(walls, kRadiusM, kCellM)) {
  for (int k = 0; k < kDirections; ++k) {
    Table& table = tables_[static_cast<std::size_t>(k)];
    table.wall.assign(frame_.cells(), kNone);
    table.centimetres.assign(frame_.cells(), kFar);
    std::vector<float> nearest(frame_.cells(), static_cast<float>(kRadiusM * kRadiusM));
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      const Segment2<Map>& s = walls_[i].segment;
      const double normal = std::atan2(s.b.x_m - s.a.x_m, -(s.b.y_m - s.a.y_m));
      if (s.length_m() <= 0.0 || angle_between(normal, (k + 0.5) * kBinRad) > kHalfWidthRad) {
        continue;
      }
      mapping::for_each_cell_near(frame_, s, kRadiusM, [&](std::size_t cell, double d2) {
        if (static_cast<float>(d2) < nearest[cell]) {
          nearest[cell] = static_cast<float>(d2);
          table.wall[cell] = static_cast<std::uint32_t>(i);
          table.centimetres[cell] = static_cast<std::uint8_t>(std::min(254.0, 100.0 * std::sqrt(d2)));
        }
      });
    }
  }
}

int WallIndex::direction_of(double normal_x, double normal_y) {
  double angle = std::atan2(normal_y, normal_x);
  if (angle < 0.0) {
    angle += kPi;
  }
  return std::clamp(static_cast<int>(angle / kBinRad), 0, kDirections - 1);
}

WallIndex::Hit WallIndex::nearest(double x_m, double y_m, int direction) const {
  const std::int64_t cell = frame_.find({x_m, y_m});
  if (cell < 0) {
    return {};
  }
  const std::uint32_t id = tables_[static_cast<std::size_t>(direction)].wall[static_cast<std::size_t>(cell)];
  if (id == kNone) {
    return {};
  }
  const Segment2<Map>& s = walls_[id].segment;
  const double length = s.length_m();
  const double ux = (s.b.x_m - s.a.x_m) / length;
  const double uy = (s.b.y_m - s.a.y_m) / length;
  const double px = x_m - s.a.x_m;
  const double py = y_m - s.a.y_m;
  Hit hit;
  hit.wall = static_cast<int>(id);
  hit.normal_x = -uy;
  hit.normal_y = ux;
  hit.distance_m = -uy * px + ux * py;
  hit.along_m = ux * px + uy * py;
  hit.beyond_m = std::max({0.0, -hit.along_m, hit.along_m - length});
  hit.probability = walls_[id].probability;
  return hit;
}

WallIndex::Hit WallIndex::nearest(double x_m, double y_m) const {
  Hit best;
  const auto away = [](const Hit& hit) { return std::hypot(hit.distance_m, hit.beyond_m); };
  for (int direction = 0; direction < kDirections; ++direction) {
    const Hit hit = nearest(x_m, y_m, direction);
    if (hit.wall >= 0 && (best.wall < 0 || away(hit) < away(best))) best = hit;
  }
  return best;
}

}  // namespace madori::localization
