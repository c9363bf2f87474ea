#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/stamp.hpp"

namespace madori {

/// One return of a 3D lidar. Sensor-frame coordinates are small, so float is exact to micrometres.
struct CloudPoint {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float z_m = 0.0F;
  float time_offset_s = 0.0F;  ///< after the cloud's stamp
  std::uint8_t intensity = 0;
  std::uint8_t ring = 0;  ///< laser channel, lowest elevation first

  friend bool operator==(const CloudPoint&, const CloudPoint&) = default;
};

/// Points of one revolution in frame F.
template <class F>
struct PointCloud {
  Stamp stamp{};  ///< of the first firing
  std::vector<CloudPoint> points;
  std::size_t lidar = 0;  ///< which of the vehicle's lidars, where it has several
};

}  // namespace madori
