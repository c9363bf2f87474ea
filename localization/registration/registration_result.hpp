#pragma once

#include <Eigen/Core>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::localization {

/// What every registration of a scan to the map answers.
struct RegistrationResult {
  Transform2<Map, Base> map_from_base;
  bool converged = false;  ///< the last step was below the limits; false also when nothing could be matched
  int inliers = 0;         ///< points that ended close to the map
  double inlier_fraction = 0.0;  ///< of the weight of all points
  double rmse_m = 0.0;           ///< of the inliers' residuals
  /// Registration error, Eq. (1) of Kis, Csemesz, Csáji, "A SLAM algorithm for sensors with low sampling
  /// rate" (2021): mean distance to the nearest map point over the points nearer than 1 m.
  double e_psr_m = 0.0;
  double near_fraction = 0.0;  ///< of the points, those nearer than 1 m; only where a point map was matched
  /// Gauss-Newton Hessian of the weighted squared residuals in (x, y, yaw), Map frame: counts, m, m^2.
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  /// Of (x, y, yaw), Map frame: m^2, m rad, rad^2. Residual variance times the inverse of the Hessian; very
  /// large (1e4) along a direction that the scan does not see.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity() * 1e4;
};

/// `epsilon` of Eq. (1) as the paper sets it.
inline constexpr double kPsrEpsilonM = 1.0;

/// residual_variance * hessian^-1; a variance never exceeds 1e4 (an unseen direction).
[[nodiscard]] Eigen::Matrix3d covariance_from_hessian(const Eigen::Matrix3d& hessian,
                                                      double residual_variance_m2);

}  // namespace madori::localization
