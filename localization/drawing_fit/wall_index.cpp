#include "localization/drawing_fit/wall_index.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace madori::localization {
namespace {

constexpr double kCellM = 0.1;
constexpr double kHalfWidthRad = to_rad(30.0);
constexpr double kBinRad = kPi / WallIndex::kDirections;
/// Cosine and sine where the second direction begins, and the others.
struct Boundary {
  double x, y;
};
constexpr double kHalf = 0.70710678118654752;
constexpr std::array<Boundary, WallIndex::kDirections - 1> kBoundaries{
    {{0.92387953251128674, 0.38268343236508977},
     {kHalf, kHalf},
     {0.38268343236508977, 0.92387953251128674},
     {0.0, 1.0},
     {-0.38268343236508977, 0.92387953251128674},
     {-kHalf, kHalf},
     {-0.92387953251128674, 0.38268343236508977}}};

/// Of two undirected lines.
double angle_between(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, kPi));
}

}  // namespace

WallIndex::WallIndex(const mapping::Walls& walls)
    : walls_(walls), frame_(mapping::GridFrame::around(walls, kRadiusM, kCellM)) {
  for (const mapping::Wall& wall : walls_) {
    const Segment2<Map>& s = wall.segment;
    const double length = s.length_m();
    lines_.push_back(
        {s.a, (s.b.x_m - s.a.x_m) / length, (s.b.y_m - s.a.y_m) / length, length, wall.probability});
  }
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
  if (normal_y < 0.0 || (normal_y == 0.0 && std::signbit(normal_y) && normal_x < 0.0)) {
    normal_x = -normal_x;
    normal_y = -normal_y;
  }
  int direction = 0;
  for (const Boundary& b : kBoundaries) direction += b.x * normal_y >= b.y * normal_x ? 1 : 0;
  return direction;
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
  const Line& line = lines_[id];
  const double px = x_m - line.from.x_m;
  const double py = y_m - line.from.y_m;
  Hit hit;
  hit.wall = static_cast<int>(id);
  hit.normal_x = -line.along_y;
  hit.normal_y = line.along_x;
  hit.distance_m = -line.along_y * px + line.along_x * py;
  hit.along_m = line.along_x * px + line.along_y * py;
  hit.beyond_m = std::max({0.0, -hit.along_m, hit.along_m - line.length_m});
  hit.probability = line.probability;
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
