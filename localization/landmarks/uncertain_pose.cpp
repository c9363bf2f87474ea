#include "localization/landmarks/uncertain_pose.hpp"

#include "localization/landmarks/bare_math.hpp"

namespace madori::localization::landmarks {
namespace {

/// d(x, y) of a + b by the turn of a, and the turn of b's axes.
Matrix3 by_first(const Displacement& a, const Displacement& b) {
  double x = b.x_m, y = b.y_m;
  turn(a.yaw_rad, x, y);
  return {{{1.0, 0.0, -y}, {0.0, 1.0, x}, {0.0, 0.0, 1.0}}};
}

Matrix3 turned_axes(double yaw_rad) {
  double s = 0.0, c = 1.0;
  sine_cosine(yaw_rad, s, c);
  return {{{c, -s, 0.0}, {s, c, 0.0}, {0.0, 0.0, 1.0}}};
}

/// Weight of the second of two variances' values in their mean, and the variance of that mean.
struct Weighted {
  double of_second;
  double variance;
};
Weighted weighted(double first, double second) {
  if (first == kInfinity) return {1.0, second};
  if (second == kInfinity || first + second <= 0.0) return {0.0, first};
  return {first / (first + second), first * second / (first + second)};
}

}  // namespace

void turn(double yaw_rad, double& x, double& y) {
  double s = 0.0, c = 1.0;
  sine_cosine(yaw_rad, s, c);
  const double old_x = x;
  x = c * old_x - s * y;
  y = s * old_x + c * y;
}

Displacement Displacement::inverse() const {
  Displacement back{-x_m, -y_m, wrapped(-yaw_rad)};
  turn(-yaw_rad, back.x_m, back.y_m);
  return back;
}

Displacement Displacement::operator*(const Displacement& next) const {
  double x = next.x_m, y = next.y_m;
  turn(yaw_rad, x, y);
  return {x_m + x, y_m + y, wrapped(yaw_rad + next.yaw_rad)};
}

ScalarUncertainty ScalarUncertainty::unknown() {
  return {kInfinity, kInfinity};
}
ScalarUncertainty ScalarUncertainty::of(const Matrix3& covariance) {
  return {0.5 * (covariance(0, 0) + covariance(1, 1)), covariance(2, 2)};
}
bool ScalarUncertainty::is_unknown() const {
  return position_m2 == kInfinity;
}
void ScalarUncertainty::to_pages(float* pages) const {
  pages[0] = static_cast<float>(square_root(position_m2));
  pages[1] = static_cast<float>(square_root(yaw_rad2));
}
ScalarUncertainty ScalarUncertainty::from_pages(const float* pages) {
  const double d = pages[0], yaw = pages[1];
  return {d * d, yaw * yaw};
}

FullUncertainty FullUncertainty::unknown() {
  return {Matrix3::diagonal(kInfinity, kInfinity, kInfinity)};
}
bool FullUncertainty::is_unknown() const {
  return covariance(0, 0) == kInfinity;
}
void FullUncertainty::to_pages(float* pages) const {
  Matrix3 root;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      double rest = covariance(i, j);
      for (int k = 0; k < j; ++k) rest -= root(i, k) * root(j, k);
      if (i == j) root(i, i) = square_root(rest);
      if (i != j) root(i, j) = root(j, j) > 0.0 ? rest / root(j, j) : 0.0;
      *pages++ = static_cast<float>(root(i, j));
    }
}
FullUncertainty FullUncertainty::from_pages(const float* pages) {
  Matrix3 root;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) root(i, j) = *pages++;
  return {root * transposed(root)};
}

ScalarPose negated(const ScalarPose& m) {
  return {m.motion.inverse(), m.uncertainty};
}

ScalarPose added(const ScalarPose& first, const ScalarPose& second) {
  return {first.motion * second.motion,
          {first.uncertainty.position_m2 + second.uncertainty.position_m2,
           first.uncertainty.yaw_rad2 + second.uncertainty.yaw_rad2}};
}

ScalarPose fused(const ScalarPose& a, const ScalarPose& b) {
  const Weighted d = weighted(a.uncertainty.position_m2, b.uncertainty.position_m2);
  const Weighted yaw = weighted(a.uncertainty.yaw_rad2, b.uncertainty.yaw_rad2);
  const Displacement& m = a.motion;
  return {{m.x_m + d.of_second * (b.motion.x_m - m.x_m), m.y_m + d.of_second * (b.motion.y_m - m.y_m),
           wrapped(m.yaw_rad + yaw.of_second * wrapped(b.motion.yaw_rad - m.yaw_rad))},
          {d.variance, yaw.variance}};
}

FullPose negated(const FullPose& m) {
  if (m.uncertainty.is_unknown()) return {m.motion.inverse(), m.uncertainty};
  const Displacement back = m.motion.inverse();
  // -M + M = 0, so J_first(-M, M) d(-M) + R d(M) = 0.
  const Matrix3 j = inverse(by_first(back, m.motion)) * turned_axes(back.yaw_rad);
  return {back, {symmetric(carried(j, m.uncertainty.covariance))}};
}

FullPose added(const FullPose& first, const FullPose& second) {
  const Displacement sum = first.motion * second.motion;
  if (first.uncertainty.is_unknown() || second.uncertainty.is_unknown())
    return {sum, FullUncertainty::unknown()};
  const Matrix3 covariance = carried(by_first(first.motion, second.motion), first.uncertainty.covariance) +
                             carried(turned_axes(first.motion.yaw_rad), second.uncertainty.covariance);
  return {sum, {symmetric(covariance)}};
}

FullPose fused(const FullPose& a, const FullPose& b) {
  if (a.uncertainty.is_unknown()) return b;
  if (b.uncertainty.is_unknown()) return a;
  const Matrix3& p = a.uncertainty.covariance;
  if (p(0, 0) + p(1, 1) + p(2, 2) == 0.0) return a;
  const Matrix3 gain = p * inverse(p + b.uncertainty.covariance);
  const Vector3 step = gain * Vector3{{b.motion.x_m - a.motion.x_m, b.motion.y_m - a.motion.y_m,
                                       wrapped(b.motion.yaw_rad - a.motion.yaw_rad)}};
  const Matrix3 kept = Matrix3::diagonal(1.0, 1.0, 1.0) - gain;
  return {{a.motion.x_m + step[0], a.motion.y_m + step[1], wrapped(a.motion.yaw_rad + step[2])},
          {symmetric(carried(kept, p) + carried(gain, b.uncertainty.covariance))}};
}

}  // namespace madori::localization::landmarks
