#include "localization/drawing_fit/wall_index.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace madori::localization {
namespace {

constexpr double kCellM = 0.1;
constexpr double kHalfWidthRad = to_rad(30.0);
constexpr double kBinRad = 2.0 * kPi / WallIndex::kDirections;
/// Cosine and sine where the second direction of half a turn begins, and the others.
struct Boundary {
  double x, y;
};
constexpr double kHalf = 0.70710678118654752;
constexpr std::array<Boundary, WallIndex::kDirections / 2 - 1> kBoundaries{
    {{0.92387953251128674, 0.38268343236508977},
     {kHalf, kHalf},
     {0.38268343236508977, 0.92387953251128674},
     {0.0, 1.0},
     {-0.38268343236508977, 0.92387953251128674},
     {-kHalf, kHalf},
     {-0.92387953251128674, 0.38268343236508977}}};

}  // namespace

WallIndex::WallIndex(const mapping::Walls& walls, const std::vector<VisibleFace>& faces)
    : walls_(walls), frame_(mapping::GridFrame::around(walls, kRadiusM, kCellM)) {
  for (std::size_t i = 0; i < walls_.size(); ++i) add_lines(static_cast<int>(i), faces[i]);
  for (int k = 0; k < kDirections; ++k) fill(k);
}

void WallIndex::add_lines(int wall, const VisibleFace& face) {
  const mapping::Wall& drawn = walls_[static_cast<std::size_t>(wall)];
  const Segment2<Map>& s = drawn.segment;
  const double length = s.length_m();
  if (length <= 0.0) return;
  const double along_x = (s.b.x_m - s.a.x_m) / length, along_y = (s.b.y_m - s.a.y_m) / length;
  for (std::size_t side = 0; side < 2; ++side)
    for (const SeenStretch& seen : face[side])
      lines_[side].push_back({wall, s.a, along_x, along_y, seen, drawn.probability});
}

void WallIndex::fill(int direction) {
  Table& table = tables_[static_cast<std::size_t>(direction)];
  table.line.assign(frame_.cells(), kNone);
  table.centimetres.assign(frame_.cells(), kFar);
  std::vector<float> nearest(frame_.cells(), static_cast<float>(kRadiusM * kRadiusM));
  const double looks_rad = (direction + 0.5) * kBinRad;
  for (const std::uint32_t side : {0U, 1U}) {
    const double sign = side == 0 ? 1.0 : -1.0;  // of the left normal
    for (std::uint32_t i = 0; i < lines_[side].size(); ++i) {
      const Line& line = lines_[side][i];
      const double normal = std::atan2(sign * line.along_x, -sign * line.along_y);
      if (std::abs(wrap_angle(normal - looks_rad)) > kHalfWidthRad) continue;
      const auto at = [&](double m) {
        return Point2<Map>{line.from.x_m + m * line.along_x, line.from.y_m + m * line.along_y};
      };
      const Segment2<Map> seen{at(line.seen.from_m), at(line.seen.to_m)};
      mapping::for_each_cell_near(frame_, seen, kRadiusM, [&](std::size_t cell, double d2) {
        if (static_cast<float>(d2) >= nearest[cell]) return;
        nearest[cell] = static_cast<float>(d2);
        table.line[cell] = 2 * i + side;
        table.centimetres[cell] = static_cast<std::uint8_t>(std::min(254.0, 100.0 * std::sqrt(d2)));
      });
    }
  }
}

int WallIndex::direction_of(double normal_x, double normal_y) {
  const bool turned = normal_y < 0.0 || (normal_y == 0.0 && normal_x < 0.0);
  if (turned) {
    normal_x = -normal_x;
    normal_y = -normal_y;
  }
  int direction = turned ? kDirections / 2 : 0;
  for (const Boundary& b : kBoundaries) direction += b.x * normal_y >= b.y * normal_x ? 1 : 0;
  return direction;
}

WallIndex::Hit WallIndex::nearest(double x_m, double y_m, int direction) const {
  const std::int64_t cell = frame_.find({x_m, y_m});
  if (cell < 0) {
    return {};
  }
  const std::uint32_t id = tables_[static_cast<std::size_t>(direction)].line[static_cast<std::size_t>(cell)];
  if (id == kNone) {
    return {};
  }
  const Line& line = lines_[id % 2][id / 2];
  const double px = x_m - line.from.x_m;
  const double py = y_m - line.from.y_m;
  Hit hit;
  hit.wall = line.wall;
  hit.normal_x = -line.along_y;
  hit.normal_y = line.along_x;
  hit.distance_m = -line.along_y * px + line.along_x * py;
  hit.along_m = line.along_x * px + line.along_y * py;
  hit.beyond_m = std::max({0.0, line.seen.from_m - hit.along_m, hit.along_m - line.seen.to_m});
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
