#include "localization/localizer/pose_covariance.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace madori::localization {

Eigen::Matrix3d with_floor(const Eigen::Matrix3d& covariance) {
  return covariance + Eigen::Matrix3d(Eigen::Vector3d(2.5e-5, 2.5e-5, 2.5e-5).asDiagonal());
}

Eigen::Matrix3d matched_covariance(const MatchResult& match, const MapState& map) {
  const Eigen::Matrix3d floor = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  Eigen::Matrix3d covariance = (match.information + Eigen::Matrix3d::Identity()).inverse() + floor;
  if (map.drawing && map.evidence.walls_seen > 0.0) {
    const double share =
        map.drawing->walls.standing().model().sigma_m * map.drawing->walls.standing().model().sigma_m;
    const double walls = std::max(1.0, 0.1 * map.evidence.inliers * map.evidence.walls_seen);
    covariance.diagonal() += Eigen::Vector3d(share, share, 0.01 * share) * (1.0 + 4.0 / walls) * 0.5;
  }
  return covariance;
}

}  // namespace madori::localization
