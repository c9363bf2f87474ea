#pragma once

#include <vector>

#include "core/odometry.hpp"
#include "core/pose_estimate.hpp"
#include "localization/memory/memory.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// A pose of the vehicle at a moment.
struct MomentPose {
  Stamp stamp{};
  Transform2<Map, Base> map_from_base;
};

/// What is left when a drive ends.
struct FinishedMap {
  Memory memory;                  ///< what was seen, and where from
  std::vector<MomentPose> scans;  ///< the pose at every scan that lies in the map, in the order of the log
  int lost_scans = 0;             ///< scans that lie nowhere in it
  std::vector<Stamp>
      carried;  ///< of scans to which no motion leads from the one before: the vehicle was carried
};

/// Builds a map from a drive: simultaneous localization and mapping. Map frame: the first pose is its origin.
/// Deterministic. Estimates are causal; `finish` looks at all of the drive once more.
class Mapper {
 public:
  Mapper() = default;
  Mapper& operator=(const Mapper&) = delete;
  virtual ~Mapper() = default;

  virtual PoseEstimate on_odometry(const OdometryReading& reading) = 0;
  /// `points` are Base frame, `sensor` is where the lidar sits.
  virtual PoseEstimate on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) = 0;
  /// At the end of the drive; the mapper is of no use afterwards.
  [[nodiscard]] virtual FinishedMap finish() = 0;

 protected:
  Mapper(const Mapper&) = default;  // for a mapper that looks at its end on a copy of itself
};

}  // namespace madori::localization
