#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "core/frames.hpp"
#include "core/stamp.hpp"
#include "core/transform2.hpp"

namespace madori {

/// How far a pose can be trusted. Motion is refused while Lost.
enum class LocalizationState { Localized, Degraded, Ambiguous, Lost };
inline constexpr std::array kLocalizationStates{LocalizationState::Localized, LocalizationState::Degraded,
                                                LocalizationState::Ambiguous, LocalizationState::Lost};

[[nodiscard]] constexpr const char* to_string(LocalizationState state) {
  switch (state) {
    case LocalizationState::Localized:
      return "LOCALIZED";
    case LocalizationState::Degraded:
      return "DEGRADED";
    case LocalizationState::Ambiguous:
      return "AMBIGUOUS";
    case LocalizationState::Lost:
      return "LOST";
  }
  return "LOST";
}

struct LocalizationHealth {
  LocalizationState state = LocalizationState::Lost;
  std::string reason;  ///< in an operator's words; empty while Localized
  double place = 0.0;  ///< probability that the vehicle is within 1 m and 20 degrees of the pose
};

/// Where the vehicle is on the drawing.
struct PoseEstimate {
  Stamp stamp{};
  Transform2<Map, Base> map_from_base;
  /// Of (x, y, yaw) in the Map frame: m^2, m*rad, rad^2.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  LocalizationHealth health;
  /// What has moved everything that was seen around the vehicle, and the vehicle with it, since its source
  /// began: it lay elsewhere than was thought. A step of this is no motion.
  Transform2<Map, Map> moved{};
};

}  // namespace madori
