#pragma once

#include "core/frames.hpp"
#include "core/laser_scan.hpp"
#include "core/lidar_model.hpp"
#include "core/point_cloud.hpp"
#include "core/transform2.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// Points on walls of one revolution of a 3D lidar, from a region of interest above the equipment: there it
/// sees walls over machines and through gaps (Sasaki, Tsuda, Matsushita, Electronics 13, 1082 (2024),
/// section 2.3, figure 5). In each sector the returns are split into surfaces by distance, each judged by its
/// number of returns and its vertical extent; what stands like a wall is kept, far surfaces seen through gaps
/// as well, thinned by a voxel grid. Weights tell how much of the possible height was seen. Height,
/// elevations and the step between the lasers are those of `lidar`. Of a planar one, which sees every wall at
/// one height only, all returns within 80 m are kept, with full weight.
[[nodiscard]] ScanPoints extract_walls(const PointCloud<Base>& cloud, const LidarModel& lidar);

/// The returns of a 2D scan, where a person's legs and a wall differ only in shape, with the normals of the
/// lines that they support and weights by the lines' lengths. Lines by splitting at the farthest point (Ramer
/// 1972) of each run of neighbours.
[[nodiscard]] ScanPoints extract_walls(const LaserScan& scan, const Transform2<Base, Lidar>& base_from_lidar);
/// The same of returns in the order of the beams, such below kWallNearestM left out.
[[nodiscard]] ScanPoints extract_walls(ScanPoints points);
inline constexpr double kWallNearestM = 0.1;

}  // namespace madori::localization
