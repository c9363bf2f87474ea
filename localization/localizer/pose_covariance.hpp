#pragma once

#include <Eigen/Core>

#include "localization/localizer/map_state.hpp"

namespace madori::localization {

/// What a step of the wheels never gets more exact than: 5 mm, 0.3 degrees.
[[nodiscard]] Eigen::Matrix3d with_floor(const Eigen::Matrix3d& covariance);

/// Of a pose that was matched, (x, y, yaw) in Map axes: what the scan says, and what the drawing's own error
/// adds: walls that are drawn wrong lead all alike.
[[nodiscard]] Eigen::Matrix3d matched_covariance(const MatchResult& match, const MapState& map);

}  // namespace madori::localization
