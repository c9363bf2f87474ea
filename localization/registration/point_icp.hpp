#pragma once

#include "localization/registration/point_map.hpp"
#include "localization/registration/registration_result.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

struct PointIcpOptions {
  int max_iterations = 50;
  double first_distance_m = 1.0;  ///< pairs farther apart are left out; halved an iteration down to the last
  double last_distance_m = 0.3;
  double inlier_distance_m = 0.15;
  double step_limit_m = 1e-4;  ///< converged below both
  double step_limit_rad = 1e-5;
};

/// Point-to-point ICP (Besl and McKay, PAMI 14, 1992) with the closed-form rigid step of each pairing.
[[nodiscard]] RegistrationResult point_icp(const ScanPoints& points, const PointMap& map,
                                           const Transform2<Map, Base>& initial,
                                           const PointIcpOptions& options = {});

/// Fit of `points` at `map_from_base` against the map's points: the last part of every point registration.
[[nodiscard]] RegistrationResult point_fit(const ScanPoints& points, const PointMap& map,
                                           const Transform2<Map, Base>& map_from_base,
                                           double inlier_distance_m = 0.15);

}  // namespace madori::localization
