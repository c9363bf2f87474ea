#pragma once

#include "sensors/lidar/registry.hpp"

namespace madori::sensors::s300 {

/// This lidar's row of the registry.
[[nodiscard]] LidarRow row();

}  // namespace madori::sensors::s300
