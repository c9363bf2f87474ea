#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/frames.hpp"
#include "core/path.hpp"
#include "core/transform2.hpp"
#include "localization/registration/segment_grid.hpp"
#include "mapping/wall_map/distance_field.hpp"

namespace madori::localization {

/// The lidar as the forecast imagines it.
struct ForecastLidar {
  int beams = 360;
  double angle_min_rad = -kPi;
  double angle_step_rad = 2.0 * kPi / 360.0;
  double range_max_m = 30.0;
  double range_sigma_m = 0.03;
  double visible = 0.7;  ///< share of the beams that meet a wall and not something undrawn
};

/// How well a scan at one place will fix the pose.
struct Localizability {
  Transform2<Map, Base> map_from_base;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();     ///< of (x, y, yaw), Map frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< its inverse; 1e4 along unseen directions
  double worst_sigma_m = 0.0;  ///< standard deviation of the position in its least certain direction ...
  double worst_direction_rad = 0.0;  ///< ... which is this one: along a bare corridor
  double sigma_yaw_rad = 0.0;
};

/// Fisher information of the expected scan at a pose, from the map alone: sum over the beams of J J^T /
/// sigma^2, where J is the slope of a beam's range in the pose (Censi, On achievable accuracy for
/// range-finder localization, ICRA 2007, Eq. 2).
[[nodiscard]] Localizability localizability(const SegmentGrid& walls, const mapping::DistanceField& field,
                                            const Transform2<Map, Base>& map_from_base,
                                            const ForecastLidar& lidar = {});

/// The forecast at every point of a path.
[[nodiscard]] std::vector<Localizability> localizability_along(const SegmentGrid& walls,
                                                               const mapping::DistanceField& field,
                                                               const Path& path,
                                                               const ForecastLidar& lidar = {});

}  // namespace madori::localization
