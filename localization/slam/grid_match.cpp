#include "localization/slam/grid_match.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "localization/memory/local_map.hpp"

namespace madori::localization {
namespace {

constexpr double kLikelySigmaM = 0.05;  // of a point from its surface
// What a point is worth that lies on no surface: looked through, never looked at; and the share of points
// that are anything (people, glass).
constexpr double kInFree = 0.05;
constexpr double kInUnknown = 0.3;

double off_surface(const SurfacePoint& p, const SurfaceGrid::Surface& s) {
  return s.normal_x * (p.x_m - s.x_m) + s.normal_y * (p.y_m - s.y_m);
}

constexpr double kFreedom = 4.0;     // of the wheels' Student's t
constexpr std::size_t kAsked = 100;  // points of a scan: it counts as a dozen beams anyway

}  // namespace

double PosePrior::log_density(const Transform2<Map, Base>& pose) const {
  const Eigen::Vector3d e = pose_difference(pose, map_from_base);
  return -0.5 * (kFreedom + 3.0) * std::log1p(e.dot(information * e) / kFreedom);
}

double PosePrior::weight(const Transform2<Map, Base>& pose) const {
  const Eigen::Vector3d e = pose_difference(pose, map_from_base);
  return (kFreedom + 3.0) / (kFreedom + e.dot(information * e));
}

GridMatch match_to_grid(const SurfaceScan& scan, const SurfaceGrid& map, const Transform2<Map, Base>& start,
                        const PosePrior& prior) {
  GridMatch match;
  match.map_from_base = start;
  constexpr int kIterations = 8;
  for (int i = 0; i < kIterations; ++i) {
    const double shrink = std::max(0.0, 1.0 - i / 4.0);
    const int reach = i < 3 ? 3 : 2;
    const double kernel_m = 0.08 + 0.2 * shrink;
    const Transform2<Map, Base> pose = match.map_from_base;
    Eigen::Matrix3d hessian = prior.weight(pose) * prior.information;
    Eigen::Vector3d gradient = hessian * pose_difference(pose, prior.map_from_base);
    int inliers = 0;
    for (const SurfacePoint& p : scan.points) {
      const SurfacePoint q = moved(pose, p);
      SurfaceGrid::Surface s;
      if (!map.nearest(q, reach, s)) continue;
      const double r = off_surface(q, s);
      inliers += std::abs(r) < 0.1;
      const double ratio = r / kernel_m;
      const double weight =
          1.0 / ((1.0 + ratio * ratio) * (1.0 + ratio * ratio)) / (kResidualSigmaM * kResidualSigmaM);
      const Eigen::Vector3d j(s.normal_x, s.normal_y,
                              -s.normal_x * (q.y_m - pose.y_m()) + s.normal_y * (q.x_m - pose.x_m()));
      hessian += weight * j * j.transpose();
      gradient += weight * r * j;
    }
    const Eigen::Vector3d step = -(hessian + 1e-6 * Eigen::Matrix3d::Identity()).ldlt().solve(gradient);
    match.map_from_base = {pose.x_m() + step[0], pose.y_m() + step[1], pose.yaw_rad() + step[2]};
    match.information = hessian;
    match.inlier_share = inliers / static_cast<double>(std::max<std::size_t>(scan.points.size(), 1));
    if (i >= 4 && step.head<2>().norm() < 5e-4 && std::abs(step[2]) < 5e-5) break;
  }
  return match;
}

double log_likelihood(const SurfaceScan& scan, const SurfaceGrid& map, const Transform2<Map, Base>& pose,
                      double beams) {
  if (scan.points.empty()) return 0.0;
  double sum = 0.0;
  const std::size_t every = (scan.points.size() + kAsked - 1) / kAsked;
  std::size_t asked = 0;
  for (std::size_t i = 0; i < scan.points.size(); i += every, ++asked) {
    const SurfacePoint q = moved(pose, scan.points[i]);
    SurfaceGrid::Surface s;
    double likely = 0.0;
    if (map.nearest(q, 1, s)) {
      const double r = off_surface(q, s) / kLikelySigmaM;
      likely = kInFree + (1.0 - kInFree) * std::exp(-0.5 * r * r);
    } else {
      likely = map.content(q.x_m, q.y_m) == SurfaceGrid::Content::Unknown ? kInUnknown : kInFree;
    }
    sum += std::log(likely);
  }
  return sum * std::min(1.0, beams / static_cast<double>(asked));
}

}  // namespace madori::localization
