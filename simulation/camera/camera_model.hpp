#pragma once

#include <cstdint>
#include <vector>

#include "simulation/factory.hpp"

namespace madori::simulation {

struct CameraOptions {
  int width_px = 320;
  int height_px = 180;
  double field_of_view_deg = 90.0;  ///< across
  double tilt_deg = 8.0;            ///< downwards
  double height_m = 1.1;            ///< over the floor, at the vehicle's front
  double range_max_m = 60.0;
};

/// Blue, green, red bytes, rows from the top: as OpenCV has them.
struct CameraPicture {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> bgr;
};

/// What a camera at the vehicle's front sees now: a ray a pixel, shaded by material, slant and distance.
/// A pinhole without blur or noise. The same factory gives the same picture.
[[nodiscard]] CameraPicture take_picture(const Factory& factory, const CameraOptions& options = {});

}  // namespace madori::simulation
