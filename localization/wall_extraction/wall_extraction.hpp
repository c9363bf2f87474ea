#pragma once

#include "core/frames.hpp"
#include "core/laser_scan.hpp"
#include "core/lidar_model.hpp"
#include "core/point_cloud.hpp"
#include "core/transform2.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// From a 3D lidar. The region of interest lies above the equipment: there the lidar sees walls over machines
/// and through gaps (Sasaki, Tsuda, Matsushita, Electronics 13, 1082 (2024), section 2.3, figure 5).
struct CloudWallOptions {
  double min_height_m =
      1.6;  ///< of the region of interest, Base frame: above equipment, most heads and loads
  double max_height_m = 6.0;
  double min_range_m = 0.6;  ///< of the lidar
  double max_range_m = 80.0;
  int sectors = 720;           ///< the fans, by azimuth about the lidar
  double surface_gap_m = 0.2;  ///< returns of a sector farther apart than this are of two surfaces
  double least_extent =
      0.5;  ///< of the height that the lasers could have covered on the surface at its distance
  double voxel_m = 0.1;
};

/// Points on walls of one revolution: in each sector the returns are split into surfaces by distance, each
/// judged by its number of returns and its vertical extent; what stands like a wall is kept, far surfaces
/// seen through gaps as well, thinned by a voxel grid. Weights tell how much of the possible height was seen.
/// Height, elevations and the step between the lasers are those of `lidar`. Of a planar one, which sees every
/// wall at one height only, all returns within `max_range_m` are kept, with full weight.
[[nodiscard]] ScanPoints extract_walls(const PointCloud<Base>& cloud, const LidarModel& lidar,
                                       const CloudWallOptions& options = {});

/// From a 2D lidar, where a person's legs and a wall differ only in shape.
struct ScanWallOptions {
  double gap_m = 0.3;        ///< neighbours farther apart (plus 5 % of the range) are of two surfaces
  double straight_m = 0.04;  ///< a surface bends where it leaves the chord by more (plus 0.5 % of the range)
  double sure_length_m =
      0.8;  ///< a straight stretch as long as this is surely a wall, shorter ones in proportion
  double least_weight = 0.1;  ///< of a return without any line
  double range_min_m = 0.1;
};

/// The returns of a 2D scan with the normals of the lines that they support and weights by the lines'
/// lengths. Lines by splitting at the farthest point (Ramer 1972) of each run of neighbours.
[[nodiscard]] ScanPoints extract_walls(const LaserScan& scan, const Transform2<Base, Lidar>& base_from_lidar,
                                       const ScanWallOptions& options = {});

}  // namespace madori::localization
