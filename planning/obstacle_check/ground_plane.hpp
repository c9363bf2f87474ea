#pragma once

#include <vector>

#include "core/point_cloud.hpp"

namespace madori::planning {

/// The floor before the vehicle, Base frame: z = offset + slope_x * x + slope_y * y.
struct GroundPlane {
  double offset_m = 0.0;
  double slope_x = 0.0;
  double slope_y = 0.0;
  int points = 0;  ///< that agree; 0 where none could be fitted and the wheels' own plane is taken

  [[nodiscard]] double height_of(const CloudPoint& p) const {
    return static_cast<double>(p.z_m) - offset_m - slope_x * static_cast<double>(p.x_m) -
           slope_y * static_cast<double>(p.y_m);
  }
};

/// Fits the floor by repeated least squares within a shrinking band. Non-finite points are left out.
[[nodiscard]] GroundPlane fit_ground(const std::vector<CloudPoint>& points_base);

}  // namespace madori::planning
