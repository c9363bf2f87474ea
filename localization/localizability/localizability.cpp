#include "localization/localizability/localizability.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "localization/registration/registration_result.hpp"

namespace madori::localization {
namespace {

/// Slope of the range along a beam in (x, y, yaw); zero where the wall is met too flatly to tell its range.
Eigen::Vector3d range_slope(const GridSegment& wall, double dx, double dy, double range_m) {
  constexpr double kFlattest = 0.1;  // cosine
  const double nx = -wall.uy;
  const double ny = wall.ux;
  const double incidence = nx * dx + ny * dy;
  if (std::abs(incidence) < kFlattest) return Eigen::Vector3d::Zero();
  return {-nx / incidence, -ny / incidence, range_m * (nx * dy - ny * dx) / incidence};
}

}  // namespace

Localizability localizability(const SegmentGrid& walls, const mapping::DistanceField& field,
                              const Transform2<Map, Base>& map_from_base, const ForecastLidar& lidar) {
  Localizability result;
  result.map_from_base = map_from_base;
  const double per_beam = lidar.visible / (lidar.range_sigma_m * lidar.range_sigma_m);
  for (int i = 0; i < lidar.beams; ++i) {
    const double angle = map_from_base.yaw_rad() + lidar.angle_min_rad + i * lidar.angle_step_rad;
    const double dx = std::cos(angle);
    const double dy = std::sin(angle);
    const double range = field.free_way_m(map_from_base.translation(), dx, dy, lidar.range_max_m);
    if (range >= lidar.range_max_m) continue;
    const GridSegment* wall =
        walls.nearest(map_from_base.x_m() + range * dx, map_from_base.y_m() + range * dy);
    if (wall == nullptr) continue;
    const Eigen::Vector3d slope = range_slope(*wall, dx, dy, range);
    result.information += per_beam * wall->weight * slope * slope.transpose();
  }
  result.covariance = covariance_from_hessian(result.information, 1.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> position(result.covariance.topLeftCorner<2, 2>());
  result.worst_sigma_m = std::sqrt(std::max(position.eigenvalues()[1], 0.0));
  result.worst_direction_rad = std::atan2(position.eigenvectors()(1, 1), position.eigenvectors()(0, 1));
  result.sigma_yaw_rad = std::sqrt(std::max(result.covariance(2, 2), 0.0));
  return result;
}

std::vector<Localizability> localizability_along(const SegmentGrid& walls,
                                                 const mapping::DistanceField& field, const Path& path,
                                                 const ForecastLidar& lidar) {
  std::vector<Localizability> forecast;
  for (const PathPoint& p : path.points)
    forecast.push_back(localizability(walls, field, {p.position.x_m, p.position.y_m, p.heading_rad}, lidar));
  return forecast;
}

}  // namespace madori::localization
