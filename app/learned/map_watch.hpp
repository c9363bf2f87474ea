#pragma once

#include <mutex>
#include <optional>

#include "app/learned/latest_look.hpp"
#include "core/lidar_model.hpp"
#include "core/point_cloud.hpp"
#include "core/pose_estimate.hpp"
#include "localization/ndt_map/map_learner.hpp"

namespace madori::app {

/// The living map of a running vehicle. It looks on only, on a thread of its own: the drive under way does
/// not depend on it. A look that comes while it is busy takes the place of the one that waits.
class MapWatch {
 public:
  /// Goes on with what earlier drives left.
  explicit MapWatch(localization::HybridMap begun);

  /// On the cycle's thread, after every sweep: copies one now and then. True where it did.
  bool see(const PointCloud<Base>& sweep, const LidarModel& lidar, const PoseEstimate& pose);
  /// As it is now; from any thread.
  [[nodiscard]] localization::HybridMap map() const;
  [[nodiscard]] std::size_t looks() const;

 private:
  struct Look {
    PointCloud<Base> sweep;
    LidarModel lidar;
    PoseEstimate pose;
  };

  std::optional<Stamp> handed_;  ///< stamp of the last sweep that was copied
  mutable std::mutex mutex_;     ///< of the map
  localization::MapLearner learner_;
  LatestLook<Look> looks_taken_;  ///< last: its thread uses all of the above
};

}  // namespace madori::app
