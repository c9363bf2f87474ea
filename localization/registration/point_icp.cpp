#include "localization/registration/point_icp.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// Weighted sums from which the best rigid transform of a pairing follows.
struct Pairing {
  double w = 0, px = 0, py = 0, qx = 0, qy = 0, dot = 0, cross = 0;

  void add(const Point2<Base>& p, const Point2<Map>& q, double weight) {
    w += weight;
    px += weight * p.x_m;
    py += weight * p.y_m;
    qx += weight * q.x_m;
    qy += weight * q.y_m;
    dot += weight * (p.x_m * q.x_m + p.y_m * q.y_m);
    cross += weight * (p.x_m * q.y_m - p.y_m * q.x_m);
  }

  [[nodiscard]] Pose best() const {
    const double c = dot - (px * qx + py * qy) / w;
    const double s = cross - (px * qy - py * qx) / w;
    const Pose turn(0.0, 0.0, std::atan2(s, c));
    const Point2<Map> turned = turn * Point2<Base>{px / w, py / w};
    return {qx / w - turned.x_m, qy / w - turned.y_m, turn.yaw_rad()};
  }
};

Pairing pair_up(const ScanPoints& points, const PointMap& map, const Pose& pose, double limit_m) {
  Pairing pairing;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2<Base> p = points.point(i);
    const PointMap::Neighbour n = map.nearest(pose * p);
    if (n.squared_distance_m2 < limit_m * limit_m) pairing.add(p, map.points()[n.index], points.weight_of(i));
  }
  return pairing;
}

}  // namespace

RegistrationResult point_fit(const ScanPoints& points, const PointMap& map, const Pose& pose,
                             double inlier_distance_m) {
  RegistrationResult result;
  result.map_from_base = pose;
  if (map.empty()) return result;
  double near_sum = 0.0, square_sum = 0.0, inlier_weight = 0.0, weight_sum = 0.0;
  int near = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2<Map> p = pose * points.point(i);
    const double squared = map.nearest(p).squared_distance_m2;
    const double distance = std::sqrt(squared);
    const double weight = points.weight_of(i);
    weight_sum += weight;
    if (distance < kPsrEpsilonM) near_sum += distance, ++near;
    if (distance >= inlier_distance_m) continue;
    ++result.inliers;
    inlier_weight += weight;
    square_sum += squared;
    const double rx = p.x_m - pose.x_m();
    const double ry = p.y_m - pose.y_m();
    Eigen::Matrix3d h;
    h << 1.0, 0.0, -ry, 0.0, 1.0, rx, -ry, rx, rx * rx + ry * ry;
    result.hessian += weight * h;
  }
  result.inlier_fraction = weight_sum > 0.0 ? inlier_weight / weight_sum : 0.0;
  result.e_psr_m = near > 0 ? near_sum / near : kPsrEpsilonM;
  result.rmse_m = result.inliers > 0 ? std::sqrt(square_sum / result.inliers) : 0.0;
  result.covariance =
      covariance_from_hessian(result.hessian, std::max(square_sum / 2.0, 1e-6) / std::max(result.inliers, 1));
  return result;
}

RegistrationResult point_icp(const ScanPoints& points, const PointMap& map, const Pose& initial,
                             const PointIcpOptions& options) {
  Pose pose = initial;
  double limit = options.first_distance_m;
  bool converged = false;
  int iteration = 0;
  while (iteration < options.max_iterations && !converged && !map.empty()) {
    const Pairing pairing = pair_up(points, map, pose, limit);
    ++iteration;
    if (pairing.w <= 0.0) break;
    const Pose next = pairing.best();
    const Transform2<Base, Base> moved = pose.inverse() * next;
    converged = limit <= options.last_distance_m &&
                std::hypot(moved.x_m(), moved.y_m()) < options.step_limit_m &&
                std::abs(moved.yaw_rad()) < options.step_limit_rad;
    limit = std::max(options.last_distance_m, limit * 0.5);
    pose = next;
  }
  RegistrationResult result = point_fit(points, map, pose, options.inlier_distance_m);
  result.converged = converged && pose.is_finite() && result.inliers > 2;
  result.iterations = iteration;
  return result;
}

}  // namespace madori::localization
