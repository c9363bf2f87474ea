#pragma once

#include <memory>
#include <vector>

#include "app/runner/vehicle_link.hpp"
#include "control/drive_link/wire.hpp"
#include "sensors/lidar/lidar.hpp"
#include "simulation/factory.hpp"

namespace madori::app {

/// The virtual factory in lock-step: the cycle gets what the devices' bytes decode to, the drive gets the
/// bytes of its commands. Time goes on in collect() alone.
class FactoryLink final : public VehicleLink {
 public:
  FactoryLink(std::shared_ptr<simulation::Factory> factory, const WheelGeometry& wheels, Duration step);

  void collect(CycleInput& input) override;
  void send(const CycleOutput& output) override;
  [[nodiscard]] std::string problem() const override { return ""; }

 private:
  /// A lidar of the factory, in the site's order.
  struct Decoding {
    std::string type;
    std::size_t unit = 0;  ///< among those of its type
    bool keeps_bytes = false;
    bool stops = false;  ///< by its newest sweep
    std::unique_ptr<sensors::LidarDecoder> decoder;
  };

  void take(const simulation::DevicePacket& packet, CycleInput& input);
  void take_sweep(std::size_t lidar, sensors::LidarSweep& sweep);
  [[nodiscard]] Decoding* decoding_of(const simulation::DevicePacket& packet);

  std::shared_ptr<simulation::Factory> factory_;
  WheelGeometry wheels_;
  Duration step_;
  std::vector<PointCloud<Lidar>> clouds_;
  std::vector<std::int64_t> firings_us_;
  std::vector<LaserScan> scans_;
  std::vector<Decoding> lidars_;
  control::wire::FrameCutter cutter_;
  std::uint16_t sequence_ = 0;
};

}  // namespace madori::app
