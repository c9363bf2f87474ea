#pragma once

#include <cmath>

#include "core/angle.hpp"
#include "core/point2.hpp"

namespace madori {

/// Rigid transform of the plane: p_To = R(yaw) * p_From + t. Adjacent frames must cancel, and the compiler
/// checks it: `map_from_odom * odom_from_base` is a `Transform2<Map, Base>`.
template <class To, class From>
class Transform2 {
 public:
  Transform2() = default;
  /// Metres and radians; the yaw is wrapped into [-pi, pi).
  Transform2(double x_m, double y_m, double yaw_rad)
      : x_m_(x_m),
        y_m_(y_m),
        yaw_rad_(wrap_angle(yaw_rad)),
        cos_(std::cos(yaw_rad)),
        sin_(std::sin(yaw_rad)) {}

  [[nodiscard]] double x_m() const { return x_m_; }
  [[nodiscard]] double y_m() const { return y_m_; }
  [[nodiscard]] double yaw_rad() const { return yaw_rad_; }
  [[nodiscard]] double cos_yaw() const { return cos_; }
  [[nodiscard]] double sin_yaw() const { return sin_; }
  /// Where From's origin lies in To.
  [[nodiscard]] Point2<To> translation() const { return {x_m_, y_m_}; }

  [[nodiscard]] Transform2<From, To> inverse() const {
    return {-(cos_ * x_m_ + sin_ * y_m_), -(-sin_ * x_m_ + cos_ * y_m_), -yaw_rad_};
  }

  [[nodiscard]] Point2<To> operator*(const Point2<From>& p) const {
    return {cos_ * p.x_m - sin_ * p.y_m + x_m_, sin_ * p.x_m + cos_ * p.y_m + y_m_};
  }

  [[nodiscard]] Segment2<To> operator*(const Segment2<From>& s) const { return {*this * s.a, *this * s.b}; }

  template <class Inner>
  [[nodiscard]] Transform2<To, Inner> operator*(const Transform2<From, Inner>& inner) const {
    const Point2<To> t = *this * Point2<From>{inner.x_m(), inner.y_m()};
    return {t.x_m, t.y_m, yaw_rad_ + inner.yaw_rad()};
  }

  [[nodiscard]] bool is_finite() const {
    return std::isfinite(x_m_) && std::isfinite(y_m_) && std::isfinite(yaw_rad_);
  }

 private:
  double x_m_ = 0.0;
  double y_m_ = 0.0;
  double yaw_rad_ = 0.0;
  double cos_ = 1.0;
  double sin_ = 0.0;
};

}  // namespace madori
