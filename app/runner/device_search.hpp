#pragma once

#include <string>
#include <vector>

#include "app/runner/socket_link.hpp"

namespace madori::app {

/// Somebody who answered where nobody was listening yet.
struct AnsweringDevice {
  std::string type;     ///< a kind of lidar, or drive
  std::string address;  ///< as site.yaml writes it; of the drive a serial port
  double rate_hz = 0.0;
};

/// The serial adapters of this computer, by names that stay when they are plugged in elsewhere.
[[nodiscard]] std::vector<std::string> serial_ports();

/// Listens for every kind of lidar, and for a drive, where `taken` sensors and `drive_device` are not: on the
/// usual UDP ports, at the usual hosts and those this computer has spoken with lately, and on all serial
/// ports. Sends nothing but what a lidar's start needs. Takes about four seconds.
[[nodiscard]] std::vector<AnsweringDevice> search_devices(const std::vector<mapping::SensorRecord>& taken,
                                                          const std::string& drive_device);

}  // namespace madori::app
