#pragma once

#include <random>

#include "localization/memory/memory.hpp"
#include "tests/support/bent_building.hpp"
#include "tests/support/ray_caster.hpp"

namespace madori::test {

struct BentMemoryOptions {
  double metres = 100.0;   ///< of the lap
  double spacing_m = 0.5;  ///< of the keyframes
  double range_sigma_m = 0.015;
  double clutter = 0.0;  ///< share of the beams
  int beams = 450;
  double range_max_m = 25.0;
};

/// What a vehicle remembers that drove the lap with its poses known: keyframes in the Building frame.
inline localization::Memory bent_memory(const BentBuilding& building, const BentMemoryOptions& options) {
  std::mt19937 engine(building.options.seed + 1000);
  ScanSettings settings = full_turn(options.beams, options.range_max_m);
  settings.range_sigma_m = options.range_sigma_m;
  settings.clutter = options.clutter;
  localization::SurfaceScanOptions surfaces;
  surfaces.range_max_m = options.range_max_m;
  localization::Memory memory;
  for (const Point2<Map>& p : along_lap(building, options.spacing_m, options.metres)) {
    const Point2<Building> at = building.warp->building(p);
    const Transform2<Map, Base> pose(at.x_m, at.y_m, 0.0);
    const LaserScan scan = simulate_scan(building.truth, pose, settings, engine);
    std::vector<Point2<Base>> points;
    for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
      if (!std::isfinite(scan.ranges_m[i])) continue;
      points.push_back(
          {scan.ranges_m[i] * std::cos(scan.angle_rad(i)), scan.ranges_m[i] * std::sin(scan.angle_rad(i))});
    }
    memory.add(localization::make_surface_scan({}, {0.0, 0.0}, points, surfaces), options.spacing_m, pose,
               Eigen::Matrix3d::Identity() * 1e4);
  }
  return memory;
}

}  // namespace madori::test
