#pragma once

#include <cstddef>
#include <vector>

#include "core/path.hpp"
#include "core/transform2.hpp"

namespace madori::control {

/// How fast the vehicle may move along a path.
struct SpeedLimits {
  double max_speed_mps = 1.0;
  double max_turn_rate_radps = 1.0;
  double deceleration_mps2 = 0.4;          ///< comfortable, before corners and the goal
  double lateral_acceleration_mps2 = 0.5;  ///< in curves
  double reaction_s = 0.25;                ///< between what is aimed at and what the wheels do

  /// The greatest speed from which the vehicle stands still after `distance_m`, reaction included.
  [[nodiscard]] double speed_to_stop_within(double distance_m) const;
  /// ... on a curve, by its turn rate and what it does to the load. Any sign of the curvature.
  [[nodiscard]] double speed_on_curve(double curvature_per_m) const;
};

/// A stretch of the path that is driven without a turn on the spot: points [first, end).
struct PathPiece {
  std::size_t first = 0;
  std::size_t end = 0;
};

/// Where the vehicle is beside one piece of a path.
struct PathPlace {
  std::size_t index = 0;       ///< the point before it
  double along_m = 0.0;        ///< from the beginning of the path; beyond its end where the piece was passed
  double cross_track_m = 0.0;  ///< positive left of the path
};

/// A path made ready to be followed: distances, pieces between turns on the spot, and the speed that every
/// point allows by its limit, its curvature, and what comes after it.
class TrackedPath {
 public:
  TrackedPath() = default;
  /// Precondition: every value of the path is finite (speed limits may be infinite).
  TrackedPath(Path path, const SpeedLimits& limits);

  [[nodiscard]] const std::vector<PathPoint>& points() const { return path_.points; }
  [[nodiscard]] const std::vector<PathPiece>& pieces() const { return pieces_; }
  [[nodiscard]] bool empty() const { return path_.points.empty(); }
  [[nodiscard]] double along_m(std::size_t index) const { return along_m_[index]; }
  [[nodiscard]] double length_m() const { return along_m_.empty() ? 0.0 : along_m_.back(); }
  /// The speed allowed at a point of the path; zero at the end of every piece.
  [[nodiscard]] double speed_at(const PathPiece& piece, double along_m) const;
  /// The vehicle beside a piece of two points or more; the search goes at most 2 m ahead of `hint` and never
  /// back before it.
  [[nodiscard]] PathPlace locate(const PathPiece& piece, std::size_t hint,
                                 const Transform2<Map, Base>& map_from_base) const;
  /// The point at a distance along such a piece, beyond its end straight ahead; `hint` as of locate().
  [[nodiscard]] Point2<Map> point_at(const PathPiece& piece, std::size_t hint, double along_m) const;

 private:
  void find_pieces();
  void make_speed_profile(const SpeedLimits& limits);

  Path path_;
  std::vector<double> along_m_;
  std::vector<double> speed_mps_;
  std::vector<PathPiece> pieces_;
};

}  // namespace madori::control
