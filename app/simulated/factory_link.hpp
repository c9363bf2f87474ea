#pragma once

#include <memory>
#include <vector>

#include "app/runner/vehicle_link.hpp"
#include "control/drive_link/wire.hpp"
#include "sensors/s300/telegram.hpp"
#include "sensors/vlp16/assembler.hpp"
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
  void take(const simulation::DevicePacket& packet, CycleInput& input);

  std::shared_ptr<simulation::Factory> factory_;
  WheelGeometry wheels_;
  Duration step_;
  std::vector<PointCloud<Lidar>> clouds_;
  std::vector<std::int64_t> firings_us_;
  sensors::s300::Stream scanner_;
  bool field_interrupted_ = false;
  sensors::vlp16::Assembler assembler_;
  control::wire::FrameCutter cutter_;
  std::uint16_t sequence_ = 0;
};

}  // namespace madori::app
