#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/laser_scan.hpp"
#include "core/transform2.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::test {

/// Distance from `origin` along `angle_rad` to the first wall, metres; kNoReturn when there is none.
/// Brute force over all walls: an oracle that cannot be wrong in an interesting way.
inline double cast_ray(const mapping::Walls& walls, const Point2<Map>& origin, double angle_rad) {
  const double dx = std::cos(angle_rad);
  const double dy = std::sin(angle_rad);
  double nearest = LaserScan::kNoReturn;
  for (const auto& [id, s, probability] : walls) {
    const double ex = s.b.x_m - s.a.x_m;
    const double ey = s.b.y_m - s.a.y_m;
    const double wx = s.a.x_m - origin.x_m;
    const double wy = s.a.y_m - origin.y_m;
    const double denominator = dx * ey - dy * ex;
    if (std::abs(denominator) < 1e-12) continue;
    const double along_ray = (wx * ey - wy * ex) / denominator;
    const double along_wall = (wx * dy - wy * dx) / denominator;
    if (along_ray >= 0.0 && along_wall >= 0.0 && along_wall <= 1.0) nearest = std::min(nearest, along_ray);
  }
  return nearest;
}

/// A made-up 2D lidar in the Base origin.
struct ScanSettings {
  int beams = 540;
  double angle_min_rad = -0.75 * kPi;
  double angle_step_rad = to_rad(0.5);
  double range_max_m = 30.0;
  double range_sigma_m = 0.0;
  /// Share of the beams that end on something unmapped between sensor and wall, in runs of about 10 beams.
  double clutter = 0.0;
};

inline ScanSettings full_turn(int beams, double range_max_m) {
  ScanSettings settings;
  settings.beams = beams;
  settings.angle_min_rad = -kPi;
  settings.angle_step_rad = 2.0 * kPi / beams;
  settings.range_max_m = range_max_m;
  return settings;
}

/// Shortens runs of beams as people, pallets and machines do until `share` of all beams are short.
template <class Engine>
void add_clutter(LaserScan& scan, double share, Engine& engine) {
  const int beams = static_cast<int>(scan.ranges_m.size());
  std::uniform_int_distribution<int> start(0, beams - 1);
  std::uniform_int_distribution<int> length(4, 24);
  std::uniform_real_distribution<double> part(0.15, 0.9);
  std::normal_distribution<double> rough(0.0, 0.03);
  std::vector<bool> hit(scan.ranges_m.size(), false);
  int short_beams = 0;
  for (int tries = 0; short_beams < share * beams && tries < 10'000; ++tries) {
    const int first = start(engine);
    const double distance = std::min<double>(scan.ranges_m[first], scan.range_max_m) * part(engine);
    for (int i = first, end = std::min(beams, first + length(engine)); i < end; ++i) {
      if (hit[i] || scan.ranges_m[i] < distance) continue;
      scan.ranges_m[i] = static_cast<float>(std::max(0.2, distance + rough(engine)));
      hit[i] = true;
      ++short_beams;
    }
  }
}

/// What the lidar sees from `map_from_base`.
template <class Engine>
LaserScan simulate_scan(const mapping::Walls& walls, const Transform2<Map, Base>& map_from_base,
                        const ScanSettings& settings, Engine& engine) {
  LaserScan scan;
  scan.angle_min_rad = settings.angle_min_rad;
  scan.angle_step_rad = settings.angle_step_rad;
  scan.range_max_m = settings.range_max_m;
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int i = 0; i < settings.beams; ++i) {
    const double angle = map_from_base.yaw_rad() + scan.angle_rad(static_cast<std::size_t>(i));
    const double range = cast_ray(walls, map_from_base.translation(), angle);
    scan.ranges_m.push_back(range < settings.range_max_m ? static_cast<float>(range) : LaserScan::kNoReturn);
  }
  add_clutter(scan, settings.clutter, engine);
  for (float& range : scan.ranges_m)
    if (std::isfinite(range) && settings.range_sigma_m > 0.0)
      range = static_cast<float>(std::max(0.05, range + settings.range_sigma_m * noise(engine)));
  return scan;
}

}  // namespace madori::test
