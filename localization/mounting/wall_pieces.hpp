#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/lidar_model.hpp"
#include "core/point_cloud.hpp"

namespace madori::localization {

/// The floor as a 3D lidar saw it, Lidar frame: z = -height + slope_x * x + slope_y * y. Both slopes are
/// those of the lidar's own axes: a lidar that leans forward sees the floor rise before it.
struct FloorSeen {
  double height_m = 0.0;
  double slope_x = 0.0;
  double slope_y = 0.0;
  double sigma_m = 0.0;  ///< of the height
  int points = 0;

  [[nodiscard]] double tilt_rad() const;
};

/// The floor below a spinning lidar, wherever that hangs: no height is assumed but that it hangs between 0.05
/// and 5 m above it, tilted by less than 12 degrees. The plane that most of the returns of its lowest lasers
/// lie on (RANSAC, fixed seed; then least squares), where it is seen in at least a quarter of the directions
/// and nothing is seen below it. Nothing where there is no such plane, and of a planar lidar.
[[nodiscard]] std::optional<FloorSeen> find_floor(const PointCloud<Lidar>& cloud, const LidarModel& lidar);

/// A straight stretch of wall as one sweep saw it, in the plane of the floor, axes of the lidar at the end of
/// the sweep.
struct WallPiece {
  Point2<Lidar> centre;
  double normal_x = 0.0;  ///< unit, towards the lidar
  double normal_y = 0.0;
  double spread_m = 0.0;  ///< RMS of the returns along it, about the centre
  int points = 0;
};

/// The lidar's motion from a moment of the sweep to its end, as lidar_end_from_lidar_then.
using MotionInSweep = std::function<Transform2<Lidar, Lidar>(Stamp moment)>;

/// Straight stretches of 0.3 to 1 m that the sweep saw: each return is moved by what the lidar did since
/// (`motion`), levelled by the floor where that was seen, and lines are fitted (split, then total least
/// squares). Of a spinning lidar the lasers nearest to level count, without what lies on the floor.
[[nodiscard]] std::vector<WallPiece> wall_pieces(const PointCloud<Lidar>& cloud, const LidarModel& lidar,
                                                 const std::optional<FloorSeen>& floor,
                                                 const MotionInSweep& motion);

}  // namespace madori::localization
