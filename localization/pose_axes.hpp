#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/angle.hpp"
#include "core/transform2.hpp"

namespace madori::localization {

/// Sigmas squared that a right pose is off by in one case of a thousand: chi-squared of three degrees.
inline constexpr double kOneInAThousand = 16.3;

/// x, y and the wrapped yaw, in the axes of frame To.
template <class To, class From>
[[nodiscard]] Eigen::Vector3d pose_difference(const Transform2<To, From>& a, const Transform2<To, From>& b) {
  return {a.x_m() - b.x_m(), a.y_m() - b.y_m(), wrap_angle(a.yaw_rad() - b.yaw_rad())};
}

/// Nearer than `limit_m` and `limit_rad`, both.
template <class To, class From>
[[nodiscard]] bool same_place(const Transform2<To, From>& a, const Transform2<To, From>& b, double limit_m,
                              double limit_rad) {
  return distance_m(a.translation(), b.translation()) < limit_m &&
         std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad())) < limit_rad;
}

/// A covariance (or information) of (x, y, yaw) in the axes of a pose of the given heading, in Map axes.
[[nodiscard]] inline Eigen::Matrix3d in_map_axes(const Eigen::Matrix3d& covariance, double yaw_rad) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r(0, 0) = r(1, 1) = std::cos(yaw_rad);
  r(0, 1) = -std::sin(yaw_rad);
  r(1, 0) = std::sin(yaw_rad);
  return r * covariance * r.transpose();
}

/// How an error of (x, y, yaw) at `from` moves `to`: one of heading swings it by their distance.
template <class To, class From>
[[nodiscard]] Eigen::Matrix3d swing(const Transform2<To, From>& from, const Transform2<To, From>& to) {
  Eigen::Matrix3d j = Eigen::Matrix3d::Identity();
  j(0, 2) = from.y_m() - to.y_m();
  j(1, 2) = to.x_m() - from.x_m();
  return j;
}

}  // namespace madori::localization
