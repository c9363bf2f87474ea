#pragma once

#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "core/stamp.hpp"
#include "core/transform2.hpp"

namespace madori::localization {

/// A point on a surface that a lidar saw, metres. The normal has unit length and looks at the sensor; it is
/// zero where the neighbourhood is no line.
struct SurfacePoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double normal_x = 0.0;
  double normal_y = 0.0;

  [[nodiscard]] bool has_normal() const { return normal_x != 0.0 || normal_y != 0.0; }
};

/// Cosine of the angle between normals of the same surface, at least.
inline constexpr double kSameSurfaceCosine = 0.7;

/// The point, and where it looks, in the frame To.
template <class To, class From>
[[nodiscard]] SurfacePoint moved(const Transform2<To, From>& pose, const SurfacePoint& p) {
  const Point2<To> q = pose * Point2<From>{p.x_m, p.y_m};
  return {q.x_m, q.y_m, pose.cos_yaw() * p.normal_x - pose.sin_yaw() * p.normal_y,
          pose.sin_yaw() * p.normal_x + pose.cos_yaw() * p.normal_y};
}

/// One scan, ready for matching: Base frame, thinned, with normals.
struct SurfaceScan {
  Stamp stamp{};
  Point2<Base> sensor;  ///< where the lidar sits
  std::vector<SurfacePoint> points;
};

/// Of a point from its surface, sigma, at the least: real surfaces are no lines.
inline constexpr double kLeastNoiseM = 0.03;

/// Sigma of a point, at most, of the lidars that there are.
inline constexpr double kUsualNoiseM = 0.04;

/// Limits of what a scan contributes.
struct SurfaceScanOptions {
  double range_max_m = 30.0;  ///< farther returns are sparse and slanted: more harm than help
  double spacing_m = 0.04;    ///< of the points kept, so that near surfaces do not outweigh far ones
  double noise_m = 0.0;       ///< of a point, sigma: beyond what lidars have, more of them tell a direction
};

/// Makes scans ready for matching, one after the other, in memory that it uses again.
class SurfaceScanner {
 public:
  /// Sorts the points by bearing from the sensor, thins them and fits a normal to each from its neighbours.
  /// `points` are Base frame in any order; non-finite points are dropped. The scan is good until the next
  /// call.
  const SurfaceScan& make(Stamp stamp, const Point2<Base>& sensor, const std::vector<Point2<Base>>& points,
                          const SurfaceScanOptions& options = {});

  /// A point as the sensor has it.
  struct Polar {
    double bearing_rad;
    double range_m;
    Point2<Base> point;
  };

 private:
  std::vector<Polar> polar_;
  std::vector<std::size_t> neighbours_;
  SurfaceScan scan_;
};

/// The same for a single scan.
[[nodiscard]] SurfaceScan make_surface_scan(Stamp stamp, const Point2<Base>& sensor,
                                            const std::vector<Point2<Base>>& points,
                                            const SurfaceScanOptions& options = {});

}  // namespace madori::localization
