#pragma once

#include <string>
#include <vector>

#include "app/cycle/cycle.hpp"
#include "mapping/site/site.hpp"
#include "sensors/lidar/lidar.hpp"

namespace madori::app {

/// A lidar as it is now.
struct LidarState {
  mapping::SensorRecord sensor;
  std::string place;
  sensors::LidarHealth health;
};

/// The vehicle's devices as the cycle meets them: sockets and serial ports, or a virtual factory in
/// lock-step.
class VehicleLink {
 public:
  VehicleLink() = default;
  VehicleLink(const VehicleLink&) = delete;
  VehicleLink& operator=(const VehicleLink&) = delete;
  virtual ~VehicleLink() = default;

  /// Puts what has arrived since the last call into `input`; never waits.
  virtual void collect(CycleInput& input) = 0;
  /// Sends the command of this step to the drive.
  virtual void send(const CycleOutput& output) = 0;
  /// What is wrong with a device, in words; empty when nothing is.
  [[nodiscard]] virtual std::string problem() const = 0;
  /// Each lidar, as its driver says; empty where there are no drivers. From any thread.
  [[nodiscard]] virtual std::vector<LidarState> lidars() const { return {}; }
};

}  // namespace madori::app
