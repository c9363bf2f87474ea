#pragma once

#include <Eigen/Core>

#include "localization/pose_axes.hpp"
#include "localization/slam/surface_grid.hpp"

namespace madori::localization {

/// The wheels' word on a pose: mean, and information of (x, y, yaw) in Map axes. Student's t with four
/// degrees of freedom: wheels that slip, and logs whose clocks leap, are far off more often than a Gaussian
/// has it.
struct PosePrior {
  Transform2<Map, Base> map_from_base;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();

  /// Logarithm of its density, without the constant.
  [[nodiscard]] double log_density(const Transform2<Map, Base>& pose) const;
  /// How much it pulls, of what a Gaussian would: less, the farther off.
  [[nodiscard]] double weight(const Transform2<Map, Base>& pose) const;
};

struct GridMatch {
  Transform2<Map, Base> map_from_base;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the scan and the prior together, Map axes
  double inlier_share = 0.0;                              ///< of the points, those on a surface, within 0.1 m
};

/// Gauss-Newton on the distances to the surfaces from `start` on, robust (Geman-McClure), leaning on the
/// prior.
[[nodiscard]] GridMatch match_to_grid(const SurfaceScan& scan, const SurfaceGrid& map,
                                      const Transform2<Map, Base>& start, const PosePrior& prior);

/// Logarithm of the likelihood of a scan at a pose: p(z | m, x). Neighbouring beams share their errors: all
/// points together count as `beams` that are independent, and at most a hundred of them are asked.
[[nodiscard]] double log_likelihood(const SurfaceScan& scan, const SurfaceGrid& map,
                                    const Transform2<Map, Base>& pose, double beams);

}  // namespace madori::localization
