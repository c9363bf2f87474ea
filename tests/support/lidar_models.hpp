#pragma once

#include "core/angle.hpp"
#include "core/lidar_model.hpp"

namespace madori::test {

/// Sixteen lasers from -15 to 15 deg, all around.
inline LidarModel spinning_lidar(const LidarMounting& mounting) {
  return {"top",         "spinning",   LidarKind::Spinning, mounting, -kPi,  kPi,  to_rad(0.2),
          to_rad(-15.0), to_rad(15.0), to_rad(2.0),         0.1,      100.0, 0.03, 0.03,
          0.0095,        0.003};
}

/// One level laser over 270 deg, every `step_deg`.
inline LidarModel planar_lidar(const LidarMounting& mounting, double step_deg = 0.5) {
  return {"front",
          "planar",
          LidarKind::Planar,
          mounting,
          to_rad(-135.0),
          to_rad(135.0),
          to_rad(step_deg),
          0.0,
          0.0,
          0.0,
          0.02,
          20.0,
          0.015,
          0.03,
          0.008,
          0.015};
}

}  // namespace madori::test
