#pragma once

#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "core/stamp.hpp"

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

/// One scan, ready for matching: Base frame, thinned, with normals.
struct SurfaceScan {
  Stamp stamp{};
  Point2<Base> sensor;  ///< where the lidar sits
  std::vector<SurfacePoint> points;
};

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
