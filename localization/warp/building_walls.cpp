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

/// Where the faces of a wall stand beside the warped wall: two where they were seen to be apart.
std::vector<double> offsets_of(const WallDeviation& wall, const WarpStatistics& statistics) {
  const auto sigma = [&](double seen_m) {  // a wall of two metres is one observation
    return statistics.residual_m * std::sqrt(1.0 + kBentPieceM / std::max(0.2, seen_m));
  };
  const double seen[2] = {wall.sides[0].seen_m, wall.sides[1].seen_m};
  const double apart = std::abs(wall.sides[0].offset_m - wall.sides[1].offset_m);
  if (seen[0] > 0.0 && seen[1] > 0.0 && apart > 2.0 * std::hypot(sigma(seen[0]), sigma(seen[1])))
    return {wall.sides[0].offset_m, wall.sides[1].offset_m};
  return {wall.offset_m()};
}

}  // namespace

mapping::Walls walls_in_building(const mapping::Walls& drawn, const WarpFit& fit) {
  mapping::Walls made;
  const DrawingWarp& warp = fit.warp;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const Segment2<Map>& s = drawn[i].segment;
    const double length = s.length_m();
    const double nx = length > 0.0 ? -(s.b.y_m - s.a.y_m) / length : 0.0;
    const double ny = length > 0.0 ? (s.b.x_m - s.a.x_m) / length : 0.0;
    const int pieces = pieces_of(s, warp);
    const WallDeviation deviation = i < fit.walls.size() ? fit.walls[i] : WallDeviation{};
    for (const double offset_m : offsets_of(deviation, warp.statistics())) {
      const auto stands = [&](const Point2<Map>& p) {
        const Point2<Building> q = warp.building(p);
        const double turn = warp.turn_rad(p);
        return Point2<Map>{q.x_m + offset_m * (std::cos(turn) * nx - std::sin(turn) * ny),
                           q.y_m + offset_m * (std::sin(turn) * nx + std::cos(turn) * ny)};
      };
      for (int k = 0; k < pieces; ++k) {
        const Point2<Map> a = between(s, static_cast<double>(k) / pieces);
        const Point2<Map> b = between(s, (k + 1.0) / pieces);
        made.push_back({drawn[i].id, {stands(a), stands(b)}, drawn[i].probability});
      }
    }
  }
  return made;
}

}  // namespace madori::localization
