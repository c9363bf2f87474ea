#pragma once

#include "localization/landmarks/matrix3.hpp"

namespace madori::localization::landmarks {

/// A pose seen from another one, p_parent = R(yaw) p + (x, y): metres and radians. The published matrix (1)
/// is written Rot * Trans and means Trans * Rot, which is this.
struct Displacement {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;

  [[nodiscard]] Displacement inverse() const;
  [[nodiscard]] Displacement operator*(const Displacement& next) const;
};

/// R(yaw) v.
void turn(double yaw_rad, double& x, double& y);

/// The uncertainty as published: one variance for the position (m^2) and one for the orientation (rad^2). The
/// published U are its roots. Peter and Kiss, "Lightweight SLAM with automatic orientation correction using
/// 2D LiDAR scans" (2020), section II.
struct ScalarUncertainty {
  double position_m2 = 0.0;
  double yaw_rad2 = 0.0;

  static constexpr int kPages = 2;  ///< U_D and U_phi
  [[nodiscard]] static ScalarUncertainty unknown();
  /// Of a covariance of (x, y, yaw): the mean of the two axes.
  [[nodiscard]] static ScalarUncertainty of(const Matrix3& covariance);
  [[nodiscard]] bool is_unknown() const;
  void to_pages(float* pages) const;
  [[nodiscard]] static ScalarUncertainty from_pages(const float* pages);
};

/// The whole covariance of (x, y, yaw) in the axes of the pose that the displacement starts from: m^2, m rad,
/// rad^2. It knows the lever arm that the scalar form forgets.
struct FullUncertainty {
  Matrix3 covariance;

  static constexpr int kPages = 6;  ///< the lower-triangular root, which stays a root when it is rounded
  [[nodiscard]] static FullUncertainty unknown();
  [[nodiscard]] static FullUncertainty of(const Matrix3& matrix) { return {matrix}; }
  [[nodiscard]] bool is_unknown() const;
  void to_pages(float* pages) const;
  [[nodiscard]] static FullUncertainty from_pages(const float* pages);
};

/// A displacement and how far it can be trusted: the element of the algebra. `Uncertainty` is one of the two
/// above.
template <class Uncertainty>
struct UncertainPose {
  Displacement motion;
  Uncertainty uncertainty;
};
using ScalarPose = UncertainPose<ScalarUncertainty>;
using FullPose = UncertainPose<FullUncertainty>;

/// -M: the start seen from the end. Scalar: U unchanged, as published (the lever arm is neglected).
[[nodiscard]] ScalarPose negated(const ScalarPose& m);
[[nodiscard]] FullPose negated(const FullPose& m);

/// M1 + M2: one after the other, Eq. (2) to (5). Scalar: the variances add; the lever arm |t2|^2 U_phi1^2 is
/// missing, as published. The neutral element is no displacement with no uncertainty.
[[nodiscard]] ScalarPose added(const ScalarPose& first, const ScalarPose& second);
[[nodiscard]] FullPose added(const FullPose& first, const FullPose& second);

/// M1 x M2: two measurements of the same displacement as one, weighted by the inverse variances, Eq. (6) to
/// (9) in their last form (the middle one is misprinted); angles over their wrapped difference. What is
/// unknown is the neutral element on both sides.
[[nodiscard]] ScalarPose fused(const ScalarPose& a, const ScalarPose& b);
[[nodiscard]] FullPose fused(const FullPose& a, const FullPose& b);

}  // namespace madori::localization::landmarks
