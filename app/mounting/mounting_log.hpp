#pragma once

#include <optional>
#include <vector>

#include "app/cycle/cycle.hpp"
#include "localization/mounting/mounting_calibration.hpp"

namespace madori::app {

/// Keeps of the cycle's input what the calibration of the mountings needs: how far the wheels turned, and the
/// sweeps between which the vehicle moved. Live, in lock-step or from a recording.
class MountingLog {
 public:
  /// Throws Error where a wheel's size is none.
  explicit MountingLog(const WheelGeometry& wheels);

  void add(const CycleInput& input);
  [[nodiscard]] const localization::MountingDrive& drive() const { return drive_; }
  /// Dead reckoning with the wheels as believed.
  [[nodiscard]] const OdometryReading& odometry() const { return odometry_.reading(); }

 private:
  void add(const control::wire::Status& status, Stamp now);
  void add(PointCloud<Lidar> sweep);

  WheelGeometry wheels_;
  control::DiffDriveOdometry odometry_;
  sensors::DeviceClock clock_;
  std::optional<std::uint32_t> last_us_;
  std::int64_t drive_us_ = 0;
  localization::MountingDrive drive_;
  std::vector<std::optional<Transform2<Odom, Base>>> kept_at_;  ///< of each lidar's last kept sweep
};

}  // namespace madori::app
