#include "localization/ndt_map/beams.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/angle.hpp"

namespace madori::localization {
namespace {

constexpr double kLowestPlaneM = 0.2;
constexpr double kHighestPlaneM = 1.8;

}  // namespace

Beams beams_of(const ScanPoints& points, const Point2<Base>& sensor, double sensor_z_m) {
  const double z_m = std::clamp(sensor_z_m, kLowestPlaneM, kHighestPlaneM);
  Beams beams{sensor, z_m, {}};
  beams.ends.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    beams.ends.push_back({points.x_m[i], points.y_m[i], static_cast<float>(z_m)});
  return beams;
}

Beams beams_of(const PointCloud<Base>& sweep, const LidarModel& lidar) {
  constexpr std::size_t kColumns = 720;
  constexpr std::size_t kLasers = 256;  // a ring is a byte
  const LidarMounting& mounting = lidar.mounting;
  const bool planar = lidar.kind == LidarKind::Planar;
  const double plane_z_m = std::clamp(mounting.z_m, kLowestPlaneM, kHighestPlaneM);
  Beams beams{{mounting.x_m, mounting.y_m}, planar ? plane_z_m : mounting.z_m, {}};
  std::vector<bool> taken(kColumns * kLasers, false);
  for (const CloudPoint& p : sweep.points) {
    const double dx = static_cast<double>(p.x_m) - mounting.x_m;
    const double dy = static_cast<double>(p.y_m) - mounting.y_m;
    if (!std::isfinite(dx + dy + static_cast<double>(p.z_m))) continue;
    const double turn = (std::atan2(dy, dx) + kPi) / (2.0 * kPi);
    const std::size_t column = std::min(static_cast<std::size_t>(turn * kColumns), kColumns - 1);
    auto slot = taken[p.ring * kColumns + column];
    if (slot) continue;
    slot = true;
    beams.ends.push_back({p.x_m, p.y_m, planar ? static_cast<float>(plane_z_m) : p.z_m});
  }
  return beams;
}

}  // namespace madori::localization
