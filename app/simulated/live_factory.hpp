#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

#include "simulation/devices/device_hub.hpp"
#include "simulation/devices/truth_server.hpp"
#include "simulation/factory.hpp"

namespace madori::app {

/// The virtual factory in real time on a thread of its own, its devices on real sockets.
class LiveFactory {
 public:
  /// Serial ports stand in `folder`, the drive's is `folder`/drive.
  LiveFactory(const simulation::FactorySetup& setup, const std::filesystem::path& folder);
  ~LiveFactory();
  LiveFactory(const LiveFactory&) = delete;
  LiveFactory& operator=(const LiveFactory&) = delete;

  /// The sensors of the setup with the addresses where they are served; a lidar that sends by UDP has none.
  [[nodiscard]] std::vector<mapping::SensorRecord> served() const;
  /// To which port of this machine a lidar sends that sends by UDP.
  void send_to(std::uint16_t port) { hub_.set_udp_port(port); }

  /// Where the vehicle really is: for figures and pictures, never for driving.
  [[nodiscard]] simulation::GroundTruth truth() const;
  [[nodiscard]] std::vector<simulation::Collision> collisions() const;

 private:
  simulation::Factory factory_;
  simulation::DeviceHub hub_;
  simulation::TruthServer truth_server_;
  mutable std::mutex mutex_;
  simulation::GroundTruth truth_;
  std::vector<simulation::Collision> collisions_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace madori::app
