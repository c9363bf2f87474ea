#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/runner/vehicle_link.hpp"
#include "control/drive_link/drive_link.hpp"
#include "mapping/site/site.hpp"

namespace madori::app {

/// What the command line says of the devices. It overrides what site.yaml says of the same device.
struct SocketOptions {
  std::string lidar_address = "0.0.0.0";     ///< where the first lidar that sends by UDP is heard
  std::uint16_t lidar_port = 2368;           ///< ... and on which port
  std::uint16_t lidar_position_port = 8308;  ///< ... and on which one its position packets
  std::string drive_device = "/dev/ttyUSB0";
  std::string safety_scanner;          ///< serial port of the safety scanner; empty: what the site says
  unsigned scanner_baud = 0;           ///< of that port; 0: what the site says
  std::string network_scanner;         ///< HOST[:PORT] of the first lidar that is called by TCP
  std::vector<std::string> addresses;  ///< NAME=ADDRESS, any sensor of the site
};

/// The site's sensors with the addresses of the command line. Throws Error on NAME=ADDRESS for a sensor that
/// is not there.
[[nodiscard]] std::vector<mapping::SensorRecord> addressed(std::vector<mapping::SensorRecord> sensors,
                                                           const SocketOptions& options);

/// The real devices: lidars by their drivers, the drive on a serial port.
class SocketLink final : public VehicleLink {
 public:
  /// `sensors` as in site.yaml; empty: the reference vehicle's. Throws Error where a UDP port is taken.
  /// Serial ports and network devices may come later.
  SocketLink(const SocketOptions& options, const WheelGeometry& wheels,
             const std::vector<mapping::SensorRecord>& sensors = {});
  ~SocketLink() override;

  void collect(CycleInput& input) override;
  void send(const CycleOutput& output) override;
  /// Of the site's vehicle. On the thread that sends.
  void set_wheels(const WheelGeometry& wheels) { wheels_ = wheels; }
  /// Other lidars, or the same elsewhere: those at hand are closed. On the thread that collects. Throws
  /// Error.
  void set_sensors(const std::vector<mapping::SensorRecord>& sensors);
  [[nodiscard]] std::string problem() const override;
  /// Of the first lidar that is heard by UDP; 0 where there is none.
  [[nodiscard]] std::uint16_t lidar_port() const;

  [[nodiscard]] std::vector<LidarState> lidars() const override;

 private:
  struct OpenLidar;
  void take_sweep(std::size_t lidar, sensors::LidarSweep& sweep);
  void take_bytes(std::size_t lidar, std::span<const std::uint8_t> bytes, Stamp received);

  SocketOptions options_;
  WheelGeometry wheels_;
  std::mutex mutex_;
  std::vector<control::wire::Status> statuses_;
  Duration drive_behind_{};  ///< by the newest of them
  std::vector<PointCloud<Lidar>> clouds_;
  std::vector<LaserScan> scans_;
  std::vector<std::int64_t> firings_us_;
  std::vector<sensors::RawPacket> packets_;
  std::vector<mapping::SensorRecord> sensors_;       ///< that are open
  mutable std::mutex drivers_mutex_;                 ///< held while others ask, and while drivers come and go
  std::unique_ptr<control::DriveLink> drive_;        ///< last: their threads use all of the above
  std::vector<std::unique_ptr<OpenLidar>> drivers_;  ///< the vehicle's, then a scanner that only stops it
};

}  // namespace madori::app
