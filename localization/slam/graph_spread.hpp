#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "localization/memory/pose_graph.hpp"

namespace madori::localization {

/// How surely the graph knows where every keyframe is as seen from one of them: the covariance along the best
/// chain of motions (Dijkstra projection; Olson, Recognizing Places Using Spectrally Clustered Local Matches,
/// 2009). More than the least-squares graph would say, never less: chains side by side help each other.
class GraphSpread {
 public:
  /// Seen from `from`. Ties that the solved poses contradict lead nowhere.
  GraphSpread(std::size_t from, const std::vector<Transform2<Map, Base>>& poses,
              const std::vector<RelativeFactor>& factors);

  /// Covariance of (x, y, yaw) of the keyframe's pose in the axes of `from`: m, m, rad; nothing where no
  /// motions lead there.
  [[nodiscard]] const std::optional<Eigen::Matrix3d>& at(std::size_t keyframe) const {
    return spread_[keyframe];
  }
  /// Sigmas squared by which `motion` (of `keyframe` seen from `from`, known to `covariance`) is off the
  /// graph; zero where the graph says nothing of it. Chi-squared of three degrees where both are right.
  [[nodiscard]] double chi_squared(std::size_t keyframe, const Transform2<Base, Base>& motion,
                                   const Eigen::Matrix3d& covariance) const;

 private:
  Transform2<Map, Base> here_;
  const std::vector<Transform2<Map, Base>>* poses_;
  std::vector<std::optional<Eigen::Matrix3d>> spread_;
};

}  // namespace madori::localization
