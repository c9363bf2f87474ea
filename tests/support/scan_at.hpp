#pragma once

#include <random>

#include "localization/memory/surface_scan.hpp"
#include "localization/scan_points.hpp"
#include "tests/support/ray_caster.hpp"

namespace madori::test {

/// The surfaces that a lidar in the vehicle's middle sees of the walls all around, Base frame.
inline localization::SurfaceScan scan_at(const mapping::Walls& walls, const Transform2<Map, Base>& pose,
                                         std::mt19937& engine) {
  const localization::ScanPoints points =
      localization::scan_points(simulate_scan(walls, pose, full_turn(360, 30.0), engine), {});
  return localization::make_surface_scan({}, {}, weighty_points(points));
}

}  // namespace madori::test
