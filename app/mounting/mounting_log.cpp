#include "app/mounting/mounting_log.hpp"

#include <cmath>
#include <utility>

#include "core/angle.hpp"
#include "core/scan_as_cloud.hpp"

namespace madori::app {
namespace {

/// Finer than the calibration looks, which chooses among them.
constexpr double kKeepEveryRad = to_rad(2.5);
constexpr double kKeepEveryM = 0.04;

control::OdometryOptions options_for(const WheelGeometry& wheels) {
  control::OdometryOptions options;
  options.wheels = wheels;
  return options;
}

}  // namespace

MountingLog::MountingLog(const WheelGeometry& wheels) : wheels_(wheels), odometry_(options_for(wheels)) {}

void MountingLog::add(const CycleInput& input) {
  for (const auto& status : input.drive) add(status, input.now);
  for (const auto& cloud : input.clouds) add(cloud);
  for (const auto& scan : input.scans) {
    PointCloud<Lidar> sweep;
    scan_as_cloud(scan, sweep);
    add(std::move(sweep));
  }
}

void MountingLog::add(const control::wire::Status& status, Stamp now) {
  drive_us_ += last_us_ ? static_cast<std::int32_t>(status.time_us - *last_us_) : 0;
  last_us_ = status.time_us;
  clock_.observe(drive_us_, now);
  const auto before = odometry_.reading().odom_from_base;
  const auto verdict = odometry_.update(status, clock_.stamp_of(drive_us_));
  const OdometryReading& reading = odometry_.reading();
  if (verdict == control::OdometryVerdict::First) drive_.wheels.push_back({reading.stamp, 0.0, 0.0});
  if (verdict != control::OdometryVerdict::Moved || drive_.wheels.empty()) return;
  const auto turned = wheel_turns(wheels_, before.inverse() * reading.odom_from_base);
  auto next = drive_.wheels.back();
  if (reading.stamp <= next.stamp) {  // the clock was set back a little: the turn is kept with the one before
    drive_.wheels.back().left_rad += turned.left_rad;
    drive_.wheels.back().right_rad += turned.right_rad;
    return;
  }
  next = {reading.stamp, next.left_rad + turned.left_rad, next.right_rad + turned.right_rad};
  drive_.wheels.push_back(next);
}

void MountingLog::add(PointCloud<Lidar> sweep) {
  if (drive_.wheels.empty()) return;
  if (kept_at_.size() <= sweep.lidar) kept_at_.resize(sweep.lidar + 1);
  auto& last = kept_at_[sweep.lidar];
  const auto& here = odometry_.reading().odom_from_base;
  if (last) {
    const auto since = last->inverse() * here;
    if (std::abs(since.yaw_rad()) < kKeepEveryRad && std::hypot(since.x_m(), since.y_m()) < kKeepEveryM)
      return;
  }
  last = here;
  drive_.sweeps.push_back(std::move(sweep));
}

}  // namespace madori::app
