#include "planning/obstacle_check/ground_plane.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace madori::planning {
namespace {

bool is_floor(const GroundPlane& plane, const GroundOptions& options) {
  return plane.points >= options.fewest_points &&
         std::hypot(plane.slope_x, plane.slope_y) <= options.steepest &&
         std::abs(plane.offset_m) <= options.furthest_m;
}

/// Least squares over the points within `band_m` of `plane`; nothing where they lie on one line.
GroundPlane refit(const std::vector<CloudPoint>& points, const GroundPlane& plane, double band_m,
                  double reach_m) {
  constexpr double kLeastSpreadM2 = 0.02;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int count = 0;
  for (const CloudPoint& p : points) {
    const Eigen::Vector3d at = Eigen::Vector3f(p.x_m, p.y_m, p.z_m).cast<double>();
    if (!(at.head<2>().squaredNorm() <= reach_m * reach_m) || !(std::abs(plane.height_of(p)) <= band_m))
      continue;
    sum += at;
    squares.noalias() += at * at.transpose();
    ++count;
  }
  if (count < 3) return {};
  const Eigen::Vector3d mean = sum / count;
  const Eigen::Matrix3d covariance = squares / count - mean * mean.transpose();
  const Eigen::Matrix2d spread = covariance.topLeftCorner<2, 2>();
  const double trace = spread.trace();
  const double least = trace / 2.0 - std::sqrt(std::max(0.0, trace * trace / 4.0 - spread.determinant()));
  if (!(least > kLeastSpreadM2)) return {};
  const Eigen::Vector2d slope = spread.inverse() * covariance.topRightCorner<2, 1>();
  return {mean.z() - slope.dot(mean.head<2>()), slope.x(), slope.y(), count};
}

}  // namespace

GroundPlane fit_ground(const std::vector<CloudPoint>& points, const GroundOptions& options) {
  GroundPlane plane;
  const double middle_m = std::sqrt(options.first_band_m * options.last_band_m);
  for (const double band_m : std::array{options.first_band_m, middle_m, options.last_band_m}) {
    plane = refit(points, plane, band_m, options.reach_m);
    if (!is_floor(plane, options)) return {};
  }
  return plane;
}

}  // namespace madori::planning
