#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "control/diff_drive/odometry.hpp"
#include "core/laser_scan.hpp"
#include "core/odometry.hpp"
#include "core/point_cloud.hpp"
#include "sensors/lms1xx/cola.hpp"
#include "sensors/lms1xx/scan_clock.hpp"
#include "sensors/s300/scan_clock.hpp"
#include "sensors/vlp16/assembler.hpp"
#include "simulation/mailbox.hpp"

namespace madori::test {

/// The vehicle PC's side of the wires in one process: packets become core types by the very decoders that
/// stand behind the sockets, so that what comes out is decode(encode(.)) by construction, noise, rounding
/// and faults included. Decoding a revolution costs little beside casting it (tests/bench/bench_simulation).
class Receiver {
 public:
  explicit Receiver(const WheelGeometry& wheels, bool binary_lms = true);

  void push(const simulation::DevicePacket& packet);
  void push(const std::vector<simulation::DevicePacket>& packets) {
    for (const simulation::DevicePacket& p : packets) push(p);
  }

  /// What has become complete, oldest first; the caller takes them away. Lidar frames, not deskewed.
  std::deque<PointCloud<Lidar>> clouds;
  std::deque<LaserScan> lms_scans;
  std::deque<LaserScan> s300_scans;
  std::deque<OdometryReading> odometry;

  [[nodiscard]] const std::optional<sensors::s300::Fields>& fields() const { return fields_; }
  [[nodiscard]] const std::optional<control::wire::Status>& drive_status() const { return status_; }
  [[nodiscard]] const OdometryReading& latest_odometry() const { return odometry_.reading(); }
  [[nodiscard]] const sensors::vlp16::Assembler& vlp16() const { return vlp16_; }
  [[nodiscard]] const sensors::lms1xx::Splitter& lms1xx() const { return lms_; }
  [[nodiscard]] const sensors::s300::Stream& s300() const { return s300_; }
  [[nodiscard]] std::uint64_t damaged_status_frames() const { return damaged_status_; }

 private:
  void take_lms(const simulation::DevicePacket& packet);
  void take_drive(const simulation::DevicePacket& packet);

  sensors::lms1xx::Dialect dialect_;
  sensors::vlp16::Assembler vlp16_;
  sensors::lms1xx::Splitter lms_;
  sensors::lms1xx::ScanClock lms_clock_;
  sensors::s300::Stream s300_;
  sensors::s300::ScanClock s300_clock_{sensors::s300::kBitsPerSecond};
  Stamp s300_received_{};
  control::wire::FrameCutter cutter_;
  control::DiffDriveOdometry odometry_;
  std::optional<sensors::s300::Fields> fields_;
  std::optional<control::wire::Status> status_;
  std::uint64_t damaged_status_ = 0;
};

}  // namespace madori::test
