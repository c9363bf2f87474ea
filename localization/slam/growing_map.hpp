#pragma once

#include <cstdint>
#include <unordered_map>

#include "localization/registration/point_map.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

struct GrowingMapOptions {
  double voxel_m = 0.05;        ///< at most one point a voxel
  double through_sigmas = 3.0;  ///< a beam that ends so much farther has passed a point by
  double least_through_m = 0.3;
  double least_surface_m = 0.2;  ///< the points this near make the surface at one, or in so many sigmas
  double surface_sigmas = 2.0;
  double least_noise_m = 0.03;  ///< of a point from its surface: real surfaces are no lines
  int forgotten_after = 2;      ///< beams that passed a point by, more than saw it
};

/// A point map that grows scan by scan, is thinned to a point a voxel (the mean of what fell into it), and
/// forgets points that later scans look through.
class GrowingMap {
 public:
  explicit GrowingMap(const GrowingMapOptions& options = {});

  /// Adds a scan. `noise_m` is the sigma of its points, `sensor` where the lidar sits.
  void add(const ScanPoints& scan, const Transform2<Map, Base>& map_from_base, const Point2<Base>& sensor,
           double noise_m);
  [[nodiscard]] const PointMap& points() const { return points_; }
  /// Points a square metre of the map's own surface: 1/(2 sqrt(density)) is what e_psr comes to by chance
  /// among them.
  [[nodiscard]] double density_per_m2() const;
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

  GrowingMapOptions options_;
  std::unordered_map<std::uint64_t, Voxel> voxels_;
  PointMap points_{{}};
  double noise_m_ = 0.0;  ///< of the scans so far, mean
  int scans_ = 0;
};

}  // namespace madori::localization
