#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "core/stamp.hpp"

namespace madori {

/// One sweep of a 2D lidar, Lidar frame. Beam i points at angle_min_rad + i * angle_step_rad.
struct LaserScan {
  static constexpr float kNoReturn = std::numeric_limits<float>::infinity();

  Stamp stamp{};            ///< of the first beam
  Duration beam_period{0};  ///< between two beams; zero when the sweep counts as instantaneous
  double angle_min_rad = 0.0;
  double angle_step_rad = 0.0;
  double range_max_m = 0.0;        ///< beyond it the sensor reports nothing
  std::vector<float> ranges_m;     ///< kNoReturn where nothing came back
  std::vector<float> intensities;  ///< empty, or one a beam, sensor's own unit
  std::size_t lidar = 0;           ///< which of the vehicle's lidars, where it has several

  [[nodiscard]] double angle_rad(std::size_t beam) const {
    return angle_min_rad + static_cast<double>(beam) * angle_step_rad;
  }
};

}  // namespace madori
