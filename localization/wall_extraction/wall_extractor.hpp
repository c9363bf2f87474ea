#pragma once

#include <cstdint>
#include <vector>

#include "localization/wall_extraction/wall_extraction.hpp"

namespace madori::localization {

/// extract_walls() of one revolution after the other, in memory that it uses again.
class WallExtractor {
 public:
  /// Good until the next call.
  const ScanPoints& extract(const PointCloud<Base>& cloud, const LidarModel& lidar);

  /// A return inside the region of interest.
  struct Return {
    std::uint32_t sector;
    float range_m;
    float z_m;
    std::uint32_t index;
  };

 private:
  void find_region_of_interest(const PointCloud<Base>& cloud, const LidarMounting& lidar);
  void sort_returns();
  void find_surfaces(const PointCloud<Base>& cloud, const LidarModel& lidar);
  void thin();

  /// What fell into a voxel.
  struct Sum {
    double x = 0.0, y = 0.0, w = 0.0, most = 0.0;
  };
  /// A place of the table that finds a voxel's sum.
  struct Slot {
    std::uint64_t voxel = 0;
    std::int64_t sum = -1;  ///< -1: free
  };
  [[nodiscard]] Sum& sum_of(std::uint64_t voxel);

  std::vector<Return> inside_, returns_;  ///< as they came; by sector, then by range
  std::vector<std::size_t> begin_, next_;
  ScanPoints surfaces_, walls_;
  std::vector<Sum> sums_;  ///< in the order of the sectors, so that neighbours stay neighbours
  std::vector<Slot> slots_;
};

}  // namespace madori::localization
