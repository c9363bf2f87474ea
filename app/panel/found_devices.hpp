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

/// Devices that answer where none of the site's is: search_devices().
[[nodiscard]] std::vector<hmi::FoundDevice> searched_devices(
    const SocketOptions& options, const std::vector<mapping::SensorRecord>& sensors);

/// "heard" or "silent", as a word for people.
[[nodiscard]] hmi::Notice heard_or_silent(bool heard);

}  // namespace madori::app
