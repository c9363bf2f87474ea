#pragma once

#include <Eigen/Core>

#include "localization/slam/surface_grid.hpp"

namespace madori::localization {

/// A motion's word on a pose: mean, and information of (x, y, yaw) in Map axes.
struct PosePrior {
  Transform2<Map, Base> map_from_base;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

struct GridMatch {
  Transform2<Map, Base> map_from_base;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the scan and the prior together, Map axes
  double known_share = 0.0;   ///< of the points, those with the map's surfaces near them
  double inlier_share = 0.0;  ///< of the points, those on a surface, within 0.1 m
};

/// Gauss-Newton on the distances to the surfaces, robust (Geman-McClure), leaning on the prior.
[[nodiscard]] GridMatch match_to_grid(const SurfaceScan& scan, const SurfaceGrid& map,
                                      const PosePrior& prior);

/// Logarithm of the likelihood of a scan at a pose: p(z | m, x). Neighbouring beams share their errors: all
/// points together count as `beams` that are independent.
[[nodiscard]] double log_likelihood(const SurfaceScan& scan, const SurfaceGrid& map,
                                    const Transform2<Map, Base>& pose, double beams);

}  // namespace madori::localization
