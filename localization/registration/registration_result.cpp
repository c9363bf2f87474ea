#include "localization/registration/registration_result.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace madori::localization {

Eigen::Matrix3d covariance_from_hessian(const Eigen::Matrix3d& hessian, double residual_variance_m2) {
  constexpr double kUnseenVariance = 1e4;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(hessian);
  if (eigen.info() != Eigen::Success) return Eigen::Matrix3d::Identity() * kUnseenVariance;
  Eigen::Vector3d variances;
  for (int i = 0; i < 3; ++i) {
    const double information = std::max(eigen.eigenvalues()[i], 0.0);
    variances[i] = information * kUnseenVariance > residual_variance_m2 ? residual_variance_m2 / information
                                                                        : kUnseenVariance;
  }
  return eigen.eigenvectors() * variances.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace madori::localization
