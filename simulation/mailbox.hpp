#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/stamp.hpp"
#include "simulation/scenario/scenario.hpp"

namespace madori::simulation {

/// Bytes that a device sends: a UDP payload, a whole CoLa telegram, an S300 telegram, a drive frame.
struct DevicePacket {
  Device device = Device::Vlp16;
  Stamp sent{};
  std::vector<std::uint8_t> bytes;
  std::size_t unit = 0;  ///< of several devices of that kind, in the site's order
};

/// The wires of all devices, with the faults that the scenario asks for. In order of time.
class Mailbox {
 public:
  Mailbox(std::vector<FaultSpec> faults, std::uint64_t seed) : faults_(std::move(faults)), seed_(seed) {}

  /// Adds a fault, and forgets those that are over.
  void add_fault(const FaultSpec& fault, double now_s);
  [[nodiscard]] const std::vector<FaultSpec>& faults() const { return faults_; }
  /// Whether a fault of that kind troubles the device now; the first one, else null.
  [[nodiscard]] const FaultSpec* active(FaultKind kind, Device device, double now_s) const;

  /// Sends bytes through the device's faults.
  void send(Device device, std::vector<std::uint8_t> bytes, Duration now, std::size_t unit = 0);
  /// What has arrived by now, in order of arrival.
  [[nodiscard]] std::vector<DevicePacket> take(Duration now, Stamp epoch);

 private:
  struct Pending {
    Duration due{};
    Device device = Device::Vlp16;
    std::vector<std::uint8_t> bytes;
    std::size_t unit = 0;
  };
  bool damage(Device device, std::vector<std::uint8_t>& bytes, double now_s, std::uint64_t number) const;

  std::vector<FaultSpec> faults_;
  std::uint64_t seed_;
  std::uint64_t sent_[kDevices] = {};
  std::vector<Pending> pending_;
};

}  // namespace madori::simulation
