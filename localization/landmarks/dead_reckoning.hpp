#pragma once

#include <optional>

#include "core/odometry.hpp"
#include "localization/landmarks/uncertain_pose.hpp"
#include "localization/memory/memory.hpp"
#include "localization/motion_model/odometry_track.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization::landmarks {

/// The way between landmarks. The wheels alone are what a small controller has; with `match_scans` each scan
/// is also laid on what the last few metres saw, and no loop is ever closed: those are the landmarks' task.
class DeadReckoning {
 public:
  explicit DeadReckoning(bool match_scans, const MemoryOptions& options = {});

  /// Where dead reckoning is at the reading.
  Transform2<Odom, Base> on_odometry(const OdometryReading& reading);
  /// The same at a scan. `sensor` is where the lidar sits.
  Transform2<Odom, Base> on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor);
  /// The motion since this was called last, up to the newest scan.
  [[nodiscard]] FullPose take_motion();

 private:
  void match(const SurfaceScan& scan, const OdometryStep& step);

  bool match_scans_;
  MemoryOptions options_;
  OdometryModel model_;
  OdometryTrack track_;
  Memory recent_;
  std::optional<Stamp> last_scan_;
  Transform2<Map, Base> at_scan_;  ///< the memory's Map is the odometry frame here
  OdometryStep since_scan_;
  double since_keyframe_m_ = 0.0;
  FullPose motion_;
};

}  // namespace madori::localization::landmarks
