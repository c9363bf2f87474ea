#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/runner/vehicle_link.hpp"
#include "control/drive_link/drive_link.hpp"
#include "sensors/s300/receiver.hpp"
#include "sensors/vlp16/receiver.hpp"

namespace madori::app {

struct SocketOptions {
  std::string lidar_address = "0.0.0.0";
  std::uint16_t lidar_port = sensors::vlp16::kDataPort;
  std::uint16_t lidar_position_port = sensors::vlp16::kPositionPort;
  std::string drive_device = "/dev/ttyUSB0";
  std::string safety_scanner;  ///< serial port of an S300; empty where there is none
};

/// The real devices: VLP-16 on UDP, drive and S300 on serial ports.
class SocketLink final : public VehicleLink {
 public:
  /// Throws Error where a UDP port is taken. Serial ports may come later.
  SocketLink(const SocketOptions& options, const WheelGeometry& wheels);

  void collect(CycleInput& input) override;
  void send(const CycleOutput& output) override;
  /// Of the site's vehicle. On the thread that sends.
  void set_wheels(const WheelGeometry& wheels) { wheels_ = wheels; }
  [[nodiscard]] std::string problem() const override;
  [[nodiscard]] std::uint16_t lidar_port() const { return lidar_->data_port(); }

 private:
  WheelGeometry wheels_;
  std::mutex mutex_;
  std::vector<control::wire::Status> statuses_;
  std::vector<PointCloud<Lidar>> clouds_;
  std::vector<std::int64_t> firings_us_;
  std::vector<sensors::RawPacket> packets_;
  std::unique_ptr<sensors::s300::Receiver> scanner_;
  std::unique_ptr<control::DriveLink> drive_;  ///< last: their threads use all of the above
  std::unique_ptr<sensors::vlp16::Receiver> lidar_;
};

}  // namespace madori::app
