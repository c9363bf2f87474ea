#pragma once

#include <vector>

#include "app/runner/socket_link.hpp"
#include "hmi/server/vehicle.hpp"

namespace madori::app {

/// What is connected: the site's `sensors` (empty: the reference vehicle's) and the drive, whether they are
/// heard
/// (`live`), and the serial ports of this machine.
[[nodiscard]] std::vector<hmi::FoundDevice> found_devices(const SocketOptions& options,
                                                          const std::vector<mapping::SensorRecord>& sensors,
                                                          const std::vector<hmi::DeviceStatus>& live);

}  // namespace madori::app
