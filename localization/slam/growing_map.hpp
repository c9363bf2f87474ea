#pragma once

#include <cstdint>
#include <unordered_map>

#include "localization/registration/point_map.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// A point map that grows scan by scan, is thinned to a point a voxel (the mean of what fell into it), and
/// forgets points that later scans look through.
class GrowingMap {
 public:
  /// Adds a scan. `noise_m` is the sigma of its points, `sensor` where the lidar sits.
  void add(const ScanPoints& scan, const Transform2<Map, Base>& map_from_base, const Point2<Base>& sensor,
           double noise_m);
  [[nodiscard]] const PointMap& points() const { return points_; }
  [[nodiscard]] double noise_m() const { return noise_m_; }

 private:
  struct Voxel {
    double sum_x = 0.0;
    double sum_y = 0.0;
    int seen = 0;
    int passed = 0;
  };
  void look_through(const ScanPoints& scan, const Transform2<Map, Base>& map_from_base,
                    const Point2<Base>& sensor, double margin_m);

  std::unordered_map<std::uint64_t, Voxel> voxels_;
  PointMap points_{{}};
  double noise_m_ = 0.0;  ///< of the scans so far, mean
  int scans_ = 0;
};

}  // namespace madori::localization
