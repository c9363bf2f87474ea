#include "localization/warp/place_by_walls.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.hpp"
#include "core/beam_to_segment.hpp"
#include "core/segment_distance.hpp"

namespace madori::localization {
namespace {

constexpr double kNearbyM = 4.0;  ///< walls farther away say nothing of the place in the room
constexpr int kBeams = 16;
constexpr double kSeenM = 0.3;     ///< less of a wall does not tell where it stands
constexpr double kNearestM = 0.3;  ///< nearer walls count no more
/// What holds the place where the warp puts it, in beams of a wall a metre away.
constexpr double kHold = 0.05;

/// A wall seen from the place: its distance, its normal and what it stands beside its place by.
struct Seen {
  double distance_m = std::numeric_limits<double>::infinity();
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();  ///< the wall's left one
  const WallSide* side = nullptr;
};

/// Keeps the wall in `nearest` where the beam meets it before what it met so far.
void meet(const Segment2<Map>& wall, const WallDeviation& deviation, const Point2<Map>& from, double dx,
          double dy, Seen& nearest) {
  const double along_m = beam_meets_m(wall, from, dx, dy);
  if (along_m >= nearest.distance_m) return;
  const double ex = wall.b.x_m - wall.a.x_m, ey = wall.b.y_m - wall.a.y_m;
  const double length_m = std::hypot(ex, ey);
  const bool from_left = side_of(wall.a, wall.b, from) > 0.0;
  nearest = {along_m, {-ey / length_m, ex / length_m}, &deviation.sides[from_left ? 0 : 1]};
}

}  // namespace

Point2<Map> place_by_walls(const mapping::Walls& drawn, const WarpFit& fit, const Point2<Map>& place) {
  std::vector<std::size_t> around;
  for (std::size_t i = 0; i < std::min(drawn.size(), fit.walls.size()); ++i)
    if (distance_m(drawn[i].segment, place) < kNearbyM) around.push_back(i);
  Eigen::Matrix2d h = kHold * Eigen::Matrix2d::Identity();
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  for (int k = 0; k < kBeams; ++k) {
    const double direction = 2.0 * kPi * k / kBeams;
    Seen seen;
    for (const std::size_t i : around)
      meet(drawn[i].segment, fit.walls[i], place, std::cos(direction), std::sin(direction), seen);
    if (seen.side == nullptr || seen.distance_m > kNearbyM || seen.side->seen_m < kSeenM) continue;
    // By 1 / distance two walls opposite each other divide what the room is wider by as it is drawn.
    const double weight = 1.0 / std::max(kNearestM, seen.distance_m);
    h += weight * seen.normal * seen.normal.transpose();
    g += weight * seen.side->offset_m * seen.normal;
  }
  const Eigen::Vector2d beside = Eigen::Rotation2Dd(fit.warp.turn_rad(place)) * h.ldlt().solve(g);
  const Point2<Building> carried = fit.warp.building(place);
  return {carried.x_m + beside.x(), carried.y_m + beside.y()};
}

}  // namespace madori::localization
