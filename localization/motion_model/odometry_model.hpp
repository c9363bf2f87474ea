#pragma once

#include <Eigen/Core>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::localization {

/// Noise of dead reckoning with two driven wheels (Thrun, Burgard, Fox, Probabilistic Robotics, 5.4) and the
/// spread of its systematic errors before anything is known of them.
struct OdometryNoise {
  double distance_per_m = 0.06;        ///< sigma of the distance, share of the distance
  double sideways_per_m = 0.04;        ///< sigma across the heading, share of the distance
  double heading_per_m = 0.04;         ///< rad a metre
  double heading_per_rad = 0.10;       ///< share of the turn
  double standing_m = 0.005;           ///< floor of a step
  double standing_rad = 0.005;         ///< floor of a step
  double prior_distance_scale = 0.05;  ///< sigma of the unknown wheel radius
  double prior_heading_per_m = 0.06;   ///< sigma of the bias from unequal wheels, rad a metre
  double prior_heading_scale = 0.05;   ///< sigma of the unknown track width
  double walk_per_m = 0.002;           ///< how fast the systematic errors may change
};

/// Of driven wheels with encoders on a hall's floor; their systematic errors are learned.
[[nodiscard]] constexpr OdometryNoise driven_wheels() {
  return {.distance_per_m = 0.01,
          .sideways_per_m = 0.005,
          .heading_per_m = 0.005,
          .heading_per_rad = 0.02,
          .standing_m = 0.001,
          .standing_rad = 0.0005,
          .prior_distance_scale = 0.02,
          .prior_heading_per_m = 0.02,
          .prior_heading_scale = 0.03,
          .walk_per_m = 0.002};
}

/// A stretch of dead reckoning after the correction of the systematic errors.
struct OdometryStep {
  Transform2<Base, Base> motion;                         ///< the pose at its end seen from its start
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< x, y, yaw in the frame of its start
  double distance_m = 0.0;                               ///< signed, raw
  double path_m = 0.0;                                   ///< unsigned, raw
  double turn_rad = 0.0;                                 ///< signed, raw
  double turned_rad = 0.0;                               ///< unsigned, raw
};

/// Dead reckoning whose systematic errors (wheel radii, track) are estimated while driving: the true turn of
/// a step is turn * (1 + a) + distance * b, the true distance is distance * (1 + c). Kalman filter over (a,
/// b, c) fed by what scan matching measured (Censi et al. 2013, without the sensor's pose).
class OdometryModel {
 public:
  explicit OdometryModel(const OdometryNoise& noise = {});

  /// Appends the small motion between two readings to `step`, corrected.
  void extend(OdometryStep& step, const Transform2<Base, Base>& raw) const;
  /// Learns from a step whose motion was measured otherwise, with the given sigmas; by default those of a
  /// scan matched to what was seen just before.
  void learn(const OdometryStep& step, const Transform2<Base, Base>& measured, double sigma_m = 0.02,
             double sigma_rad = 0.005);

  /// a (share of the turn), b (rad a metre), c (share of the distance).
  [[nodiscard]] const Eigen::Vector3d& systematic() const { return systematic_; }

 private:
  OdometryNoise noise_;
  Eigen::Vector3d systematic_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_;
};

}  // namespace madori::localization
