#pragma once

#include "core/odometry.hpp"
#include "core/point_cloud.hpp"
#include "core/pose_estimate.hpp"

namespace madori::app {

/// What the cycle asks of localization. Deterministic: the same calls give the same poses bit for bit.
class PoseSource {
 public:
  PoseSource() = default;
  PoseSource(const PoseSource&) = delete;
  PoseSource& operator=(const PoseSource&) = delete;
  virtual ~PoseSource() = default;

  virtual PoseEstimate on_odometry(const OdometryReading& reading) = 0;
  /// One revolution, Base frame, already compensated for the motion during it.
  virtual PoseEstimate on_cloud(const PointCloud<Base>& cloud) = 0;
};

}  // namespace madori::app
