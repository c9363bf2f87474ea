#pragma once

#include <Eigen/Core>

namespace madori::mapping {

/// Points as columns; the same column of both belongs together.
using Points2N = Eigen::Matrix2Xd;

/// to = scale * R(yaw) * from + offset.
struct Similarity {
  double scale = 1.0;
  double yaw_rad = 0.0;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();

  [[nodiscard]] Eigen::Vector2d apply(const Eigen::Vector2d& p) const;
  /// Distance of each mapped point from its partner.
  [[nodiscard]] Eigen::VectorXd residuals(const Points2N& from, const Points2N& to) const;
};

/// Umeyama's least squares, never a reflection. At least two distinct points.
[[nodiscard]] Similarity fit_similarity(const Points2N& from, const Points2N& to);

/// to = R(yaw) * diag(x scale, y scale) * from + offset, least squares by Gauss-Newton.
struct StretchFit {
  double stretch = 0.0;  ///< x scale over y scale, minus 1
  double sigma = 0.0;    ///< one sigma of it, for unit noise of `to` in each coordinate
  double sum_of_squares = 0.0;
};
/// Starts at `similarity`. At least three points that are not on one line.
[[nodiscard]] StretchFit fit_stretch(const Points2N& from, const Points2N& to, const Similarity& similarity);

}  // namespace madori::mapping
