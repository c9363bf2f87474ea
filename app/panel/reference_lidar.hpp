#pragma once

#include "mapping/site/site.hpp"
#include "sensors/lidar/registry.hpp"

namespace madori::app {

/// Where the reference vehicle carries the registry's first lidar: what the set-up proposes.
inline mapping::SensorRecord reference_lidar() {
  return {"top", sensors::lidar_rows().front().type, 0.3, 0.0, 1.2, 0.0};
}

}  // namespace madori::app
