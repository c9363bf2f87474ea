#pragma once

#include "sensors/lidar/registry.hpp"

namespace madori::sensors::vlp16 {

/// This lidar's row of the registry.
[[nodiscard]] LidarRow row();

}  // namespace madori::sensors::vlp16
