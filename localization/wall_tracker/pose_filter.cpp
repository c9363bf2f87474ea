#include "localization/wall_tracker/pose_filter.hpp"

#include <Eigen/LU>
#include <cmath>

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// The covariance of `from * step`, Map axes.
Eigen::Matrix3d carried(const Eigen::Matrix3d& covariance, const Pose& from, const OdometryStep& step) {
  const Pose to = from * step.motion;
  Eigen::Matrix3d carry = Eigen::Matrix3d::Identity();
  carry(0, 2) = -(to.y_m() - from.y_m());
  carry(1, 2) = to.x_m() - from.x_m();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(0, 0) = turn(1, 1) = from.cos_yaw();
  turn(0, 1) = -from.sin_yaw();
  turn(1, 0) = from.sin_yaw();
  return carry * covariance * carry.transpose() + turn * step.covariance * turn.transpose();
}

}  // namespace

void PoseFilter::place(const Pose& map_from_base, const Eigen::Matrix3d& covariance) {
  pose_ = map_from_base;
  covariance_ = covariance;
}

void PoseFilter::predict(const OdometryStep& step) {
  covariance_ = carried(covariance_, pose_, step);
  pose_ = pose_ * step.motion;
}

void PoseFilter::correct(const Pose& measured, const Eigen::Matrix3d& measured_covariance) {
  const Eigen::Matrix3d gain = covariance_ * (covariance_ + measured_covariance).inverse();
  const Eigen::Vector3d innovation(measured.x_m() - pose_.x_m(), measured.y_m() - pose_.y_m(),
                                   wrap_angle(measured.yaw_rad() - pose_.yaw_rad()));
  const Eigen::Vector3d by = gain * innovation;
  pose_ = {pose_.x_m() + by.x(), pose_.y_m() + by.y(), pose_.yaw_rad() + by.z()};
  covariance_ = (Eigen::Matrix3d::Identity() - gain) * covariance_;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();  // rounding must not skew it
}

double PoseFilter::worst_variance_m2() const {
  const double middle = 0.5 * (covariance_(0, 0) + covariance_(1, 1));
  return middle + std::hypot(0.5 * (covariance_(0, 0) - covariance_(1, 1)), covariance_(0, 1));
}

}  // namespace madori::localization
