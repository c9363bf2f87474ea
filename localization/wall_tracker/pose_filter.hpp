#pragma once

#include <Eigen/Core>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/motion_model/odometry_model.hpp"

namespace madori::localization {

/// The pose and its covariance: the wheels predict, a registration corrects (extended Kalman filter; Thrun,
/// Burgard, Fox, Probabilistic Robotics, 3.3). Covariances are of (x, y, yaw) in Map axes: m^2, m rad, rad^2.
class PoseFilter {
 public:
  /// The vehicle is there, whatever was believed before.
  void place(const Transform2<Map, Base>& map_from_base, const Eigen::Matrix3d& covariance);
  /// The vehicle may be anywhere; the pose stays as a guess.
  void lose() { covariance_ = unknown(); }

  void predict(const OdometryStep& step);
  /// By a pose measured with the given covariance.
  void correct(const Transform2<Map, Base>& measured, const Eigen::Matrix3d& measured_covariance);

  [[nodiscard]] const Transform2<Map, Base>& pose() const { return pose_; }
  [[nodiscard]] const Eigen::Matrix3d& covariance() const { return covariance_; }
  /// Of the position along the direction that is known worst.
  [[nodiscard]] double worst_variance_m2() const;
  [[nodiscard]] double yaw_variance_rad2() const { return covariance_(2, 2); }

 private:
  [[nodiscard]] static Eigen::Matrix3d unknown() { return Eigen::Matrix3d::Identity() * 1e4; }

  Transform2<Map, Base> pose_;
  Eigen::Matrix3d covariance_ = unknown();
};

}  // namespace madori::localization
