#include "localization/registration/segment_icp.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// Signed distance to the nearest wall and the direction along which it grows.
struct Residual {
  double r = 0.0;
  double nx = 0.0;
  double ny = 0.0;
  double weight = 0.0;  ///< 0: there is no wall near, or it faces elsewhere
};

Residual residual_at(const SegmentGrid& grid, double x, double y) {
  const GridSegment* s = grid.nearest(x, y);
  if (s == nullptr) return {};
  const double px = x - s->ax;
  const double py = y - s->ay;
  const double along = px * s->ux + py * s->uy;
  const double beyond = along < 0.0 ? along : (along > s->length ? along - s->length : 0.0);
  const double across = s->ux * py - s->uy * px;
  if (beyond == 0.0) return {across, -s->uy, s->ux, s->weight};
  const double distance = std::sqrt(across * across + beyond * beyond);
  if (distance < 1e-9) return {0.0, -s->uy, s->ux, s->weight};
  const double ex = (beyond * s->ux - across * s->uy) / distance;
  const double ey = (beyond * s->uy + across * s->ux) / distance;
  return {distance, ex, ey, s->weight};
}

/// Upper triangle of the normal equations.
struct Normal {
  double xx = 0, xy = 0, xt = 0, yy = 0, yt = 0, tt = 0;
  double bx = 0, by = 0, bt = 0;
};

/// False where the point's own normal is known and differs from the wall's.
bool faces(const ScanPoints& points, std::size_t i, const Pose& pose, const Residual& e, double min_cosine) {
  if (points.normal_x.empty()) return true;
  const double nx = points.normal_x[i];
  const double ny = points.normal_y[i];
  if (nx == 0.0 && ny == 0.0) return true;
  const double mx = pose.cos_yaw() * nx - pose.sin_yaw() * ny;
  const double my = pose.sin_yaw() * nx + pose.cos_yaw() * ny;
  return std::abs(mx * e.nx + my * e.ny) >= min_cosine;
}

Normal accumulate(const ScanPoints& points, const SegmentGrid& grid, const Pose& pose, double scale,
                  std::size_t stride, double min_cosine) {
  Normal n;
  const double scale2 = scale * scale;
  const double c = pose.cos_yaw();
  const double s = pose.sin_yaw();
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const double rx = c * points.x_m[i] - s * points.y_m[i];
    const double ry = s * points.x_m[i] + c * points.y_m[i];
    const Residual e = residual_at(grid, rx + pose.x_m(), ry + pose.y_m());
    if (e.weight == 0.0 || !faces(points, i, pose, e, min_cosine)) continue;
    const double ratio = scale2 / (scale2 + e.r * e.r);
    const double w = ratio * ratio * e.weight * points.weight_of(i);
    const double jt = rx * e.ny - ry * e.nx;
    n.xx += w * e.nx * e.nx;
    n.xy += w * e.nx * e.ny;
    n.xt += w * e.nx * jt;
    n.yy += w * e.ny * e.ny;
    n.yt += w * e.ny * jt;
    n.tt += w * jt * jt;
    n.bx += w * e.nx * e.r;
    n.by += w * e.ny * e.r;
    n.bt += w * jt * e.r;
  }
  return n;
}

Eigen::Matrix3d matrix(const Normal& n) {
  Eigen::Matrix3d h;
  h << n.xx, n.xy, n.xt, n.xy, n.yy, n.yt, n.xt, n.yt, n.tt;
  return h;
}

/// The Gauss-Newton step; zero when the equations have no information at all.
Eigen::Vector3d step(const Normal& n, double prior) {
  const Eigen::Matrix3d h = matrix(n) + Eigen::Matrix3d::Identity() * prior;
  const Eigen::Vector3d delta = -h.ldlt().solve(Eigen::Vector3d(n.bx, n.by, n.bt));
  return delta.allFinite() ? delta : Eigen::Vector3d::Zero();
}

/// Shortens steps that turn back: where a wall's cell borders make the association flip, plain Gauss-Newton
/// steps to and fro over a fraction of a millimetre for ever.
class Damping {
 public:
  Eigen::Vector3d apply(const Eigen::Vector3d& delta) {
    if (delta.cwiseProduct(metric_).dot(last_) < 0.0) factor_ *= 0.5;
    last_ = delta.cwiseProduct(metric_);
    return factor_ * delta;
  }

 private:
  Eigen::Vector3d metric_{1.0, 1.0, 5.0};  // a radian moves points 5 m away by 5 m
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
  double factor_ = 1.0;
};

bool below(const Eigen::Vector3d& delta, double limit_m, double limit_rad) {
  return std::hypot(delta[0], delta[1]) < limit_m && std::abs(delta[2]) < limit_rad;
}

}  // namespace

RegistrationResult segment_fit(const ScanPoints& points, const SegmentGrid& grid, const Pose& pose,
                               const SegmentIcpOptions& options) {
  RegistrationResult result;
  result.map_from_base = pose;
  double near_sum = 0.0, square_sum = 0.0, inlier_weight = 0.0, weight_sum = 0.0;
  int near = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2<Map> p = pose * points.point(i);
    const Residual e = residual_at(grid, p.x_m, p.y_m);
    const double weight = points.weight_of(i);
    weight_sum += weight;
    if (e.weight == 0.0) continue;
    const double distance = std::abs(e.r);
    if (distance < kPsrEpsilonM) near_sum += distance, ++near;
    if (distance >= options.inlier_distance_m) continue;
    ++result.inliers;
    inlier_weight += weight;
    square_sum += e.r * e.r;
  }
  result.inlier_fraction = weight_sum > 0.0 ? inlier_weight / weight_sum : 0.0;
  result.e_psr_m = near > 0 ? near_sum / near : kPsrEpsilonM;
  result.rmse_m = result.inliers > 0 ? std::sqrt(square_sum / result.inliers) : 0.0;
  result.hessian = matrix(accumulate(points, grid, pose, options.last_scale_m, 1, options.min_normal_cosine));
  constexpr double kFloor = 0.005;  // a noise-free scan does not make the drawing exact
  result.covariance =
      covariance_from_hessian(result.hessian, std::max(result.rmse_m * result.rmse_m, kFloor * kFloor));
  return result;
}

RegistrationResult segment_icp(const ScanPoints& points, const SegmentGrid& grid, const Pose& initial,
                               const SegmentIcpOptions& options) {
  constexpr double kMostOscillation = 20.0;  // in step limits: a larger one is no convergence, damped or not
  Pose pose = initial;
  double scale = options.first_scale_m;
  Damping damping;
  bool converged = false;
  int iteration = 0;
  while (iteration < options.max_iterations && !converged) {
    const bool wide = scale > options.last_scale_m;
    const std::size_t stride = wide ? std::max<std::size_t>(1, points.size() / options.coarse_points) : 1;
    const Normal n = accumulate(points, grid, pose, scale, stride, options.min_normal_cosine);
    const Eigen::Vector3d full = step(n, options.prior_information);
    const Eigen::Vector3d delta = wide ? full : damping.apply(full);
    pose = Pose(pose.x_m() + delta[0], pose.y_m() + delta[1], pose.yaw_rad() + delta[2]);
    ++iteration;
    converged =
        !wide && n.xx + n.yy > 0.0 && below(delta, options.step_limit_m, options.step_limit_rad) &&
        below(full, kMostOscillation * options.step_limit_m, kMostOscillation * options.step_limit_rad);
    scale = std::max(options.last_scale_m, scale * options.scale_factor);
  }
  RegistrationResult result = segment_fit(points, grid, pose, options);
  result.converged = converged && pose.is_finite() && result.inliers > 2;
  return result;
}

}  // namespace madori::localization
