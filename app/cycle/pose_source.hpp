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

  /// The pose at a reading of the wheels.
  virtual PoseEstimate on_odometry(const OdometryReading& reading) = 0;
  /// One revolution, Base frame at its stamp, already compensated for the motion during it; `odom_from_base`
  /// is where the wheels were at that stamp. What was learned shows in the next on_odometry().
  virtual void on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) = 0;
};

}  // namespace madori::app
