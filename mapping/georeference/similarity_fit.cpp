#include "mapping/georeference/similarity_fit.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>

namespace madori::mapping {

Eigen::Vector2d Similarity::apply(const Eigen::Vector2d& p) const {
  return scale * (Eigen::Rotation2Dd(yaw_rad) * p) + offset;
}

Eigen::VectorXd Similarity::residuals(const Points2N& from, const Points2N& to) const {
  Eigen::VectorXd distances(from.cols());
  for (Eigen::Index i = 0; i < from.cols(); ++i) distances[i] = (apply(from.col(i)) - to.col(i)).norm();
  return distances;
}

Similarity fit_similarity(const Points2N& from, const Points2N& to) {
  // In the plane Umeyama's singular value decomposition has this closed form.
  const Eigen::Vector2d from_mean = from.rowwise().mean();
  const Eigen::Vector2d to_mean = to.rowwise().mean();
  double along = 0.0;
  double across = 0.0;
  double squares = 0.0;
  for (Eigen::Index i = 0; i < from.cols(); ++i) {
    const Eigen::Vector2d p = from.col(i) - from_mean;
    const Eigen::Vector2d q = to.col(i) - to_mean;
    along += p.dot(q);
    across += p.x() * q.y() - p.y() * q.x();
    squares += p.squaredNorm();
  }
  Similarity fit;
  fit.scale = std::hypot(along, across) / squares;
  fit.yaw_rad = std::atan2(across, along);
  fit.offset = to_mean - fit.scale * (Eigen::Rotation2Dd(fit.yaw_rad) * from_mean);
  return fit;
}

StretchFit fit_stretch(const Points2N& from, const Points2N& to, const Similarity& start) {
  using Parameters = Eigen::Matrix<double, 5, 1>;  // yaw, x scale, y scale, offset about the centre
  const Eigen::Vector2d centre = from.rowwise().mean();
  Parameters p;
  p << start.yaw_rad, start.scale, start.scale, start.apply(centre);
  Eigen::Matrix<double, Eigen::Dynamic, 5> jacobian(2 * from.cols(), 5);
  Eigen::VectorXd residual(2 * from.cols());
  for (int round = 0; round < 20; ++round) {
    const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(p[0]).toRotationMatrix();
    for (Eigen::Index i = 0; i < from.cols(); ++i) {
      const Eigen::Vector2d q = from.col(i) - centre;
      const Eigen::Vector2d turned = rotation * Eigen::Vector2d(p[1] * q.x(), p[2] * q.y());
      residual.segment<2>(2 * i) = to.col(i) - turned - p.tail<2>();
      jacobian.block<2, 1>(2 * i, 0) = Eigen::Vector2d(-turned.y(), turned.x());
      jacobian.block<2, 1>(2 * i, 1) = rotation.col(0) * q.x();
      jacobian.block<2, 1>(2 * i, 2) = rotation.col(1) * q.y();
      jacobian.block<2, 2>(2 * i, 3).setIdentity();
    }
    const Parameters step = jacobian.colPivHouseholderQr().solve(residual);
    p += step;
    if (step.norm() < 1e-12 * p.norm()) break;
  }
  StretchFit fit;
  fit.stretch = p[1] / p[2] - 1.0;
  Parameters gradient = Parameters::Zero();
  gradient[1] = 1.0 / p[2];
  gradient[2] = -p[1] / (p[2] * p[2]);
  const Eigen::Matrix<double, 5, 5> normal = jacobian.transpose() * jacobian;
  fit.sigma = std::sqrt(gradient.dot(normal.colPivHouseholderQr().solve(gradient)));
  fit.sum_of_squares = residual.squaredNorm();
  return fit;
}

}  // namespace madori::mapping
