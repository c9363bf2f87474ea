#pragma once

#include <cmath>
#include <string>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori {

enum class LidarKind {
  Spinning,  ///< several lasers at fixed elevations: a cloud a revolution
  Planar,    ///< one laser, level: a scan
};

/// Where a lidar sits, Base frame: its height above the floor, and the yaw of its x axis.
struct LidarMounting {
  double x_m;
  double y_m;
  double z_m;
  double yaw_rad;

  [[nodiscard]] Transform2<Base, Lidar> base_from_lidar() const { return {x_m, y_m, yaw_rad}; }
};

/// What a lidar sees and how well, by its data sheet, and where it is mounted. No member has a default:
/// geometry that nobody stated is wrong without anybody noticing.
struct LidarModel {
  std::string name;  ///< of this one on the vehicle, as in site.yaml
  std::string type;  ///< its kind, as in site.yaml
  LidarKind kind;
  LidarMounting mounting;
  double from_rad;  ///< field of view, Lidar frame, counter-clockwise from here
  double to_rad;
  double step_rad;  ///< between two beams of a sweep
  double min_elevation_rad;
  double max_elevation_rad;
  double ring_step_rad;  ///< between two lasers; 0 of a planar one
  double period_s;       ///< of a sweep
  double range_max_m;
  double sigma_m;          ///< statistical error of a range
  double bias_m;           ///< systematic part, at most
  double beam_m;           ///< diameter where it leaves the device
  double beam_spread_rad;  ///< how it grows with the range

  /// The farthest range at which a sweep is sure to hit a body that wide, a beam and the gap to the next one
  /// (SICK's rule; Eq. 6.1-6.3 of the tele-operated mapping source); never beyond the lidar's range.
  [[nodiscard]] double sure_range_m(double width_m) const {
    return std::fmin(std::fmax((width_m - beam_m) / (beam_spread_rad + step_rad), 0.0), range_max_m);
  }
  /// Heights of the lowest and highest laser above the floor at a distance.
  [[nodiscard]] double lowest_m(double range_m) const {
    return mounting.z_m + range_m * std::tan(min_elevation_rad);
  }
};

}  // namespace madori
