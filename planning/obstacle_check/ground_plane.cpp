#include "planning/obstacle_check/ground_plane.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace madori::planning {
namespace {

constexpr double kFloorReachM = 6.0;  ///< points further away are left out
constexpr double kFirstBandM = 0.12;  ///< around the wheels' plane, where the floor is looked for
constexpr double kLastBandM = 0.04;   ///< around the fit, in the last iteration
constexpr double kSteepest = 0.06;    ///< tilt beyond which a fit is no floor (the vehicle pitches by less)
constexpr double kFurthestFloorM = 0.06;  ///< offset beyond which a fit is no floor
constexpr int kFewestFloorPoints = 40;

bool is_floor(const GroundPlane& plane) {
  return plane.points >= kFewestFloorPoints && std::hypot(plane.slope_x, plane.slope_y) <= kSteepest &&
         std::abs(plane.offset_m) <= kFurthestFloorM;
}

/// Least squares over the points within `band_m` of `plane`; nothing where they lie on one line.
GroundPlane refit(const std::vector<CloudPoint>& points, const GroundPlane& plane, double band_m) {
  constexpr double kLeastSpreadM2 = 0.02;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  int count = 0;
  for (const CloudPoint& p : points) {
    const Eigen::Vector3d at = Eigen::Vector3f(p.x_m, p.y_m, p.z_m).cast<double>();
    if (!(at.head<2>().squaredNorm() <= kFloorReachM * kFloorReachM) ||
        !(std::abs(plane.height_of(p)) <= band_m))
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

GroundPlane fit_ground(const std::vector<CloudPoint>& points) {
  GroundPlane plane;
  const double middle_m = std::sqrt(kFirstBandM * kLastBandM);
  for (const double band_m : std::array{kFirstBandM, middle_m, kLastBandM}) {
    plane = refit(points, plane, band_m);
    if (!is_floor(plane)) return {};
  }
  return plane;
}

}  // namespace madori::planning
