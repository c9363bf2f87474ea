#include "mapping/revision/register_walls.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/segment_distance.hpp"

namespace madori::mapping {
namespace {

using Wall2 = Segment2<Map>;
constexpr std::size_t kLongest = 45;     ///< walls of each drawing that are paired
constexpr std::size_t kFirstLook = 120;  ///< samples of the new walls for every pair
constexpr std::size_t kLastLook = 2500;
constexpr std::size_t kRefined = 12;  ///< pairs that are refined
constexpr int kTurns = 12;

std::vector<Wall2> longest(std::vector<Wall2> walls) {
  std::ranges::sort(walls, std::greater<>(), &Wall2::length_m);
  walls.resize(std::min(walls.size(), kLongest));
  return walls;
}

/// About `count` points, evenly along all walls.
std::vector<Point2<Map>> sampled(const std::vector<Wall2>& walls, std::size_t count) {
  double length = 0.0;
  for (const auto& wall : walls) length += wall.length_m();
  const double step = length / static_cast<double>(count);
  std::vector<Point2<Map>> points;
  double at = step / 2.0;
  for (const auto& wall : walls) {
    const double whole = wall.length_m();
    for (; at < whole; at += step) {
      const double share = at / whole;
      points.push_back(
          {wall.a.x_m + share * (wall.b.x_m - wall.a.x_m), wall.a.y_m + share * (wall.b.y_m - wall.a.y_m)});
    }
    at -= whole;
  }
  return points;
}

struct Nearest {
  const Wall2* wall = nullptr;
  double distance = std::numeric_limits<double>::infinity();
};

Nearest nearest(const std::vector<Wall2>& walls, const Point2<Map>& point, double reach) {
  Nearest best;
  for (const auto& wall : walls) {
    if (std::min(wall.a.x_m, wall.b.x_m) > point.x_m + reach ||
        std::max(wall.a.x_m, wall.b.x_m) < point.x_m - reach ||
        std::min(wall.a.y_m, wall.b.y_m) > point.y_m + reach ||
        std::max(wall.a.y_m, wall.b.y_m) < point.y_m - reach)
      continue;
    const double d = distance_m(wall, point);
    if (d < best.distance) best = {&wall, d};
  }
  return best;
}

double covered(const std::vector<Wall2>& old_walls, const std::vector<Point2<Map>>& points,
               const Similarity& by, double within) {
  std::size_t on = 0;
  for (const auto& point : points) on += nearest(old_walls, moved(by, point), within).distance < within;
  return points.empty() ? 0.0 : static_cast<double>(on) / static_cast<double>(points.size());
}

/// How the wall `from` comes to lie on `to`, end on end.
Similarity laid(const Wall2& from, const Wall2& to) {
  Similarity by;
  by.scale = to.length_m() / from.length_m();
  by.yaw_rad = std::atan2(to.b.y_m - to.a.y_m, to.b.x_m - to.a.x_m) -
               std::atan2(from.b.y_m - from.a.y_m, from.b.x_m - from.a.x_m);
  by.offset.setZero();
  const Eigen::Vector2d a = by.apply({from.a.x_m, from.a.y_m});
  by.offset = Eigen::Vector2d(to.a.x_m, to.a.y_m) - a;
  return by;
}

/// x' = a x - b y + tx, y' = b x + a y + ty: linear in (a, b, tx, ty), so each turn is one least squares of
/// the distances to the nearest walls' lines.
Similarity refined(const std::vector<Wall2>& old_walls, const std::vector<Point2<Map>>& points, Similarity by,
                   double within) {
  for (int turn = 0; turn < kTurns; ++turn) {
    const double reach = within * std::max(1.0, 4.0 * std::pow(0.7, turn));
    Eigen::Matrix4d normal = Eigen::Matrix4d::Identity() * 1e-9;
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const auto& point : points) {
      const Point2<Map> here = moved(by, point);
      const Nearest found = nearest(old_walls, here, reach);
      if (found.distance >= reach) continue;
      const double length = found.wall->length_m();
      const double nx = -(found.wall->b.y_m - found.wall->a.y_m) / length;
      const double ny = (found.wall->b.x_m - found.wall->a.x_m) / length;
      const Eigen::Vector4d row(nx * point.x_m + ny * point.y_m, ny * point.x_m - nx * point.y_m, nx, ny);
      normal += row * row.transpose();
      right += row * (nx * found.wall->a.x_m + ny * found.wall->a.y_m);
    }
    const Eigen::Vector4d solved = normal.ldlt().solve(right);
    if (!solved.allFinite() || std::hypot(solved[0], solved[1]) < 1e-9) break;
    by = {std::hypot(solved[0], solved[1]), std::atan2(solved[1], solved[0]), {solved[2], solved[3]}};
  }
  return by;
}

struct Candidate {
  Similarity by;
  double worth = 0.0;
};

/// Covered length counts by its share: a drawing shrunk onto one wall covers little, one blown up covers
/// little of itself.
std::vector<Candidate> candidates(const std::vector<Wall2>& old_walls, const std::vector<Wall2>& new_walls,
                                  double within) {
  const auto points = sampled(new_walls, kFirstLook);
  double length = 0.0;
  for (const auto& wall : new_walls) length += wall.length_m();
  std::vector<Candidate> all;
  for (const auto& to : longest(old_walls))
    for (const auto& from : longest(new_walls))
      for (const auto& end : {to, Wall2{to.b, to.a}}) {
        if (!(from.length_m() > 0.0)) continue;
        const Similarity by = laid(from, end);
        const double share = covered(old_walls, points, by, 2.0 * within);
        all.push_back({by, share * share * by.scale * length});
      }
  const auto most = std::min(all.size(), kRefined);
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(most), all.end(),
                    [](const auto& a, const auto& b) { return a.worth > b.worth; });
  all.resize(most);
  return all;
}

}  // namespace

Point2<Map> moved(const Similarity& by, const Point2<Map>& point) {
  const Eigen::Vector2d to = by.apply({point.x_m, point.y_m});
  return {to.x(), to.y()};
}

Segment2<Map> moved(const Similarity& by, const Segment2<Map>& segment) {
  return {moved(by, segment.a), moved(by, segment.b)};
}

std::optional<WallRegistration> register_walls(const std::vector<Wall2>& old_walls,
                                               const std::vector<Wall2>& new_walls, double within,
                                               double least_covered) {
  const auto few = sampled(new_walls, kLastLook / 5);
  std::optional<WallRegistration> best;
  double most = 0.0;
  for (const auto& candidate : candidates(old_walls, new_walls, within)) {
    const Similarity by = refined(old_walls, few, candidate.by, within);
    const double share = covered(old_walls, few, by, within);
    const double worth = share * share * by.scale;
    if (worth <= most) continue;
    most = worth;
    best = WallRegistration{by, share};
  }
  if (!best) return std::nullopt;
  best = settle_walls(old_walls, new_walls, best->old_from_new, within);
  if (best->covered < least_covered) return std::nullopt;
  return best;
}

WallRegistration settle_walls(const std::vector<Wall2>& old_walls, const std::vector<Wall2>& new_walls,
                              const Similarity& from, double within) {
  const auto points = sampled(new_walls, kLastLook);
  const Similarity by = refined(old_walls, points, from, within);
  return {by, covered(old_walls, points, by, within)};
}

}  // namespace madori::mapping
