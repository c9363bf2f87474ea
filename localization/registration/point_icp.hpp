#pragma once

#include "localization/registration/point_map.hpp"
#include "localization/registration/registration_result.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

struct PointIcpOptions {
  int max_iterations = 50;
  /// Scale of the Geman-McClure loss: starts wide and shrinks by `scale_factor` an iteration, so that the
  /// ends of long beams, metres off after some degrees, still pull, and clutter lets go at last.
  double first_scale_m = 1.2;
  double last_scale_m = 0.06;
  double scale_factor = 0.7;
  double along_surface = 0.02;      ///< weight of the distance along the surface beside the distance from it
  std::size_t coarse_points = 180;  ///< while the loss is wide, about this many of the points do
  double inlier_distance_m = 0.15;
  double step_limit_m = 1e-4;  ///< converged below both
  double step_limit_rad = 1e-5;
  /// A pose to lean on, (x, y, yaw) in Map axes; the information is times the variance of one residual.
  Transform2<Map, Base> prior;
  Eigen::Matrix3d prior_information = Eigen::Matrix3d::Zero();
};

/// ICP on a point map: each point is paired with the nearest of the map and drawn to the surface that the
/// points around that one make (Segal, Haehnel, Thrun, Generalized-ICP, RSS 2009, with the uncertainty of the
/// map's side alone; Besl and McKay 1992 where the map makes no surfaces). Plain point-to-point pairs hold a
/// scan where it starts: along a wall, and in a map that noise made thick, there is always a point beside it.
[[nodiscard]] RegistrationResult point_icp(const ScanPoints& points, const PointMap& map,
                                           const Transform2<Map, Base>& initial,
                                           const PointIcpOptions& options = {});

/// Fit of `points` at `map_from_base` against the map's points: the last part of every point registration.
[[nodiscard]] RegistrationResult point_fit(const ScanPoints& points, const PointMap& map,
                                           const Transform2<Map, Base>& map_from_base,
                                           double inlier_distance_m = 0.15);

}  // namespace madori::localization
