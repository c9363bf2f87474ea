#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

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
  ~MapWatch();
  MapWatch(const MapWatch&) = delete;
  MapWatch& operator=(const MapWatch&) = delete;

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
  void run();

  std::mutex mailbox_;
  std::condition_variable wake_;
  std::optional<Look> waiting_;
  std::optional<Stamp> handed_;  ///< stamp of the last sweep that was copied
  bool stop_ = false;
  mutable std::mutex mutex_;  ///< of the map
  localization::MapLearner learner_;
  std::thread thread_;
};

}  // namespace madori::app
