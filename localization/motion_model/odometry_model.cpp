#include "localization/motion_model/odometry_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

double square(double v) {
  return v * v;
}

}  // namespace

OdometryModel::OdometryModel(const OdometryNoise& noise) : noise_(noise) {
  covariance_ = Eigen::Vector3d(square(noise.prior_heading_scale), square(noise.prior_heading_per_m),
                                square(noise.prior_distance_scale))
                    .asDiagonal();
}

void OdometryModel::extend(OdometryStep& step, const Transform2<Base, Base>& raw) const {
  const double distance = std::copysign(std::hypot(raw.x_m(), raw.y_m()), raw.x_m());
  const double turn = raw.yaw_rad();
  const double true_turn = turn * (1.0 + systematic_[0]) + distance * systematic_[1];
  const double scale = 1.0 + systematic_[2];
  // The chord of the arc leans by half of what the turn was corrected.
  const double lean = 0.5 * (true_turn - turn);
  const double c = std::cos(lean) * scale;
  const double s = std::sin(lean) * scale;
  const Transform2<Base, Base> motion(c * raw.x_m() - s * raw.y_m(), s * raw.x_m() + c * raw.y_m(),
                                      true_turn);
  // First order: the heading error so far tilts this piece.
  Eigen::Matrix3d carry = Eigen::Matrix3d::Identity();
  const Transform2<Base, Base> next = step.motion * motion;
  carry(0, 2) = -(next.y_m() - step.motion.y_m());
  carry(1, 2) = next.x_m() - step.motion.x_m();
  const double path = std::abs(distance);
  const Eigen::Vector2d heading_of(turn, distance);
  const double unknown = heading_of.dot(covariance_.topLeftCorner<2, 2>() * heading_of);
  // Variances that grow with the path add over pieces only when taken per metre, not per metre squared.
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  const double along = square(noise_.distance_per_m) * path;
  const double across = square(noise_.sideways_per_m) * path;
  const double cy = step.motion.cos_yaw();
  const double sy = step.motion.sin_yaw();
  noise(0, 0) = cy * cy * along + sy * sy * across;
  noise(1, 1) = sy * sy * along + cy * cy * across;
  noise(0, 1) = noise(1, 0) = cy * sy * (along - across);
  noise(2, 2) =
      square(noise_.heading_per_m) * path + square(noise_.heading_per_rad) * std::abs(turn) + unknown;
  step.covariance = carry * step.covariance * carry.transpose() + noise;
  step.motion = next;
  step.distance_m += distance;
  step.path_m += path;
  step.turn_rad += turn;
  step.turned_rad += std::abs(turn);
}

void OdometryModel::learn(const OdometryStep& step, const Transform2<Base, Base>& measured, double sigma_m,
                          double sigma_rad) {
  if (step.path_m < 0.05 && step.turned_rad < 0.05) {
    return;  // standing teaches nothing
  }
  const Eigen::Vector2d walk(noise_.walk_per_m * std::sqrt(step.path_m), 0.0);
  covariance_.diagonal().array() += square(walk[0]);
  const double chord = std::hypot(measured.x_m(), measured.y_m());
  const double raw_chord = std::hypot(step.motion.x_m(), step.motion.y_m()) / (1.0 + systematic_[2]);
  Eigen::Matrix<double, 2, 3> h = Eigen::Matrix<double, 2, 3>::Zero();
  h(0, 0) = step.turn_rad;
  h(0, 1) = step.distance_m;
  h(1, 2) = raw_chord;
  const Eigen::Vector2d innovation(wrap_angle(measured.yaw_rad() - step.motion.yaw_rad()),
                                   chord - raw_chord * (1.0 + systematic_[2]));
  Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();
  noise(0, 0) = square(sigma_rad) + square(noise_.heading_per_m) * step.path_m +
                square(noise_.heading_per_rad) * step.turned_rad + square(noise_.standing_rad);
  noise(1, 1) = square(sigma_m) + square(noise_.distance_per_m) * step.path_m + square(noise_.standing_m);
  const Eigen::Matrix2d s = h * covariance_ * h.transpose() + noise;
  for (int i = 0; i < 2; ++i) {  // slipping wheels are no systematic error: such a step counts less
    const double ratio = square(innovation[i]) / s(i, i);
    noise(i, i) *= std::max(1.0, ratio);
  }
  const Eigen::Matrix2d robust = h * covariance_ * h.transpose() + noise;
  const double det = robust.determinant();
  Eigen::Matrix2d inverse;
  inverse << robust(1, 1), -robust(0, 1), -robust(1, 0), robust(0, 0);
  const Eigen::Matrix<double, 3, 2> gain = covariance_ * h.transpose() * (inverse / det);
  systematic_ += gain * innovation;
  covariance_ = (Eigen::Matrix3d::Identity() - gain * h) * covariance_;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
}

}  // namespace madori::localization
