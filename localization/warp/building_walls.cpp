#include <algorithm>
#include <cmath>

#include "localization/warp/warp_fit.hpp"

namespace madori::localization {
namespace {

constexpr double kBentPieceM = 2.0;   ///< of a wall that the warp bends
constexpr double kStraightM = 0.005;  ///< what bends less than this is straight

Point2<Map> between(const Segment2<Map>& s, double share) {
  return {s.a.x_m + share * (s.b.x_m - s.a.x_m), s.a.y_m + share * (s.b.y_m - s.a.y_m)};
}

int pieces_of(const Segment2<Map>& s, const DrawingWarp& warp) {
  const Point2<Building> a = warp.building(s.a);
  const Point2<Building> b = warp.building(s.b);
  const int steps = std::max(1, static_cast<int>(std::ceil(s.length_m() / kBentPieceM)));
  for (int k = 1; k < 2 * steps; ++k) {
    const double share = k / (2.0 * steps);
    const Point2<Building> p = warp.building(between(s, share));
    const Point2<Building> chord{a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m)};
    if (distance_m(p, chord) > kStraightM) return steps;
  }
  return 1;
}

/// A face of a wall: where it stands beside the warped wall, and how surely.
struct Face {
  double offset_m;
  double sigma_m;
  bool seen;
};

std::vector<Face> faces_of(const WallDeviation& wall, const WarpStatistics& statistics) {
  const auto sigma = [&](double seen_m) {  // a wall of two metres is one observation
    return statistics.residual_m * std::sqrt(1.0 + kBentPieceM / std::max(0.2, seen_m));
  };
  const double seen[2] = {wall.sides[0].seen_m, wall.sides[1].seen_m};
  if (wall.seen_m() <= 0.0) return {{0.0, std::hypot(statistics.offset_m, statistics.residual_m), false}};
  const double apart = std::abs(wall.sides[0].offset_m - wall.sides[1].offset_m);
  if (seen[0] > 0.0 && seen[1] > 0.0 && apart > 2.0 * std::hypot(sigma(seen[0]), sigma(seen[1])))
    return {{wall.sides[0].offset_m, sigma(seen[0]), true}, {wall.sides[1].offset_m, sigma(seen[1]), true}};
  return {{wall.offset_m(), sigma(wall.seen_m()), true}};
}

}  // namespace

BuildingWalls walls_in_building(const mapping::Walls& drawn, const WarpFit& fit) {
  BuildingWalls made;
  const DrawingWarp& warp = fit.warp;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const Segment2<Map>& s = drawn[i].segment;
    const double length = s.length_m();
    const double nx = length > 0.0 ? -(s.b.y_m - s.a.y_m) / length : 0.0;
    const double ny = length > 0.0 ? (s.b.x_m - s.a.x_m) / length : 0.0;
    const int pieces = pieces_of(s, warp);
    const WallDeviation deviation = i < fit.walls.size() ? fit.walls[i] : WallDeviation{};
    for (const Face& face : faces_of(deviation, warp.statistics())) {
      const auto stands = [&](const Point2<Map>& p) {
        const Point2<Building> q = warp.building(p);
        const double turn = warp.turn_rad(p);
        return Point2<Map>{q.x_m + face.offset_m * (std::cos(turn) * nx - std::sin(turn) * ny),
                           q.y_m + face.offset_m * (std::sin(turn) * nx + std::cos(turn) * ny)};
      };
      for (int k = 0; k < pieces; ++k) {
        const Point2<Map> a = between(s, static_cast<double>(k) / pieces);
        const Point2<Map> b = between(s, (k + 1.0) / pieces);
        made.walls.push_back({drawn[i].id, {stands(a), stands(b)}, drawn[i].probability});
        const double carried = face.seen ? 0.0 : warp.sigma_m(between(s, (k + 0.5) / pieces));
        made.sigma_m.push_back(std::hypot(face.sigma_m, carried));
      }
    }
  }
  return made;
}

}  // namespace madori::localization
