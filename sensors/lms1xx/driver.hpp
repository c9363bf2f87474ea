#pragma once

#include "sensors/lidar/registry.hpp"

namespace madori::sensors::lms1xx {

/// This lidar's row of the registry.
[[nodiscard]] LidarRow row();

}  // namespace madori::sensors::lms1xx
