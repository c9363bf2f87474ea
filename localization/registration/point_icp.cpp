#include "localization/registration/point_icp.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// Weight of the distance from the middle of points that make no line: they hold a scan where it starts.
constexpr double kBlot = 0.2;

/// The Gauss-Newton sums of one pairing, in (x, y, yaw) at the pose.
struct Sums {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();

  void add(double residual, double nx, double ny, double rx, double ry, double weight) {
    const Eigen::Vector3d jacobian(nx, ny, -nx * ry + ny * rx);
    hessian += weight * jacobian * jacobian.transpose();
    gradient += weight * residual * jacobian;
  }
};

Sums pair_up(const ScanPoints& points, const PointMap& map, const Pose& pose, double scale_m,
             std::size_t stride, double along_surface) {
  Sums sums;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Point2<Map> p = pose * points.point(i);
    const PointSurface& s = map.surface(map.nearest(p).index);
    const double dx = p.x_m - s.x_m;
    const double dy = p.y_m - s.y_m;
    const double across = dx * s.normal_x + dy * s.normal_y;
    const double along = dy * s.normal_x - dx * s.normal_y;
    const double tangent = std::max(along_surface, kBlot * (1.0 - s.flatness));
    const double ratio = (across * across + tangent * along * along) / (scale_m * scale_m);
    const double weight = s.worth * points.weight_of(i) / ((1.0 + ratio) * (1.0 + ratio));
    const double rx = p.x_m - pose.x_m();
    const double ry = p.y_m - pose.y_m();
    sums.add(across, s.normal_x, s.normal_y, rx, ry, weight);
    sums.add(along, -s.normal_y, s.normal_x, rx, ry, weight * tangent);
  }
  return sums;
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
  if (!points.empty()) result.near_fraction = static_cast<double>(near) / static_cast<double>(points.size());
  result.e_psr_m = near > 0 ? near_sum / near : kPsrEpsilonM;
  result.rmse_m = result.inliers > 0 ? std::sqrt(square_sum / result.inliers) : 0.0;
  result.covariance =
      covariance_from_hessian(result.hessian, std::max(square_sum / 2.0, 1e-6) / std::max(result.inliers, 1));
  return result;
}

RegistrationResult point_icp(const ScanPoints& points, const PointMap& map, const Pose& initial,
                             const PointIcpOptions& options) {
  Pose pose = initial;
  double scale = options.first_scale_m;
  bool converged = false;
  int iteration = 0;
  const std::size_t coarse = 1 + points.size() / (options.coarse_points + 1);
  while (iteration < options.max_iterations && !converged && !map.empty() && !points.empty()) {
    const bool last = scale <= options.last_scale_m;
    Sums sums = pair_up(points, map, pose, scale, last ? std::size_t{1} : coarse, options.along_surface);
    ++iteration;
    sums.hessian += options.prior_information;
    sums.gradient += options.prior_information * pose_difference(pose, options.prior);
    const Eigen::Matrix3d regular =
        sums.hessian + 1e-6 * (1.0 + sums.hessian.trace()) * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d step = -regular.ldlt().solve(sums.gradient);
    pose = Pose(pose.x_m() + step[0], pose.y_m() + step[1], pose.yaw_rad() + step[2]);
    converged = last && std::hypot(step[0], step[1]) < options.step_limit_m &&
                std::abs(step[2]) < options.step_limit_rad;
    scale = std::max(options.last_scale_m, scale * options.scale_factor);
  }
  RegistrationResult result = point_fit(points, map, pose, options.inlier_distance_m);
  result.converged = converged && pose.is_finite() && result.inliers > 2;
  return result;
}

}  // namespace madori::localization
