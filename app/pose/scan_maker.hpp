#pragma once

#include <optional>
#include <vector>

#include "core/lidar_model.hpp"
#include "core/point_cloud.hpp"
#include "localization/scan_points.hpp"
#include "localization/wall_extraction/wall_extractor.hpp"

namespace madori::app {

/// Sweeps as the scans that localization and mapping work on. A 3D lidar's revolutions become points on walls
/// one by one. Without one, what all planar lidars saw in the last tenth of a second is one scan, merged in
/// Base.
class ScanMaker {
 public:
  /// Base frame at the stamp, where the wheels were at `odom_from_base`.
  struct Scan {
    Stamp stamp{};
    const localization::ScanPoints& points;  ///< good until the next sweep
    Transform2<Odom, Base> odom_from_base;
  };

  explicit ScanMaker(std::vector<LidarModel> lidars);

  /// Whether that lidar tells of the place.
  [[nodiscard]] bool looks(std::size_t lidar) const { return looks_[lidar]; }
  /// A sweep of a lidar that looks; the scan that it completes, where it does.
  [[nodiscard]] std::optional<Scan> on_cloud(const PointCloud<Base>& cloud,
                                             const Transform2<Odom, Base>& odom_from_base);
  [[nodiscard]] const std::vector<LidarModel>& lidars() const { return lidars_; }
  /// From where the points on walls are seen: the lidar's place, the middle between several.
  [[nodiscard]] const Point2<Base>& eye() const { return eye_; }
  [[nodiscard]] static Point2<Base> eye(const std::vector<LidarModel>& lidars);

 private:
  /// What one planar lidar saw last.
  struct Look {
    Stamp stamp{};
    localization::ScanPoints points;  ///< Base frame at the stamp
    Transform2<Odom, Base> odom_from_base;
  };
  void merge(Stamp now, const Transform2<Odom, Base>& odom_from_base);

  std::vector<LidarModel> lidars_;
  std::vector<bool> looks_;
  Point2<Base> eye_;
  localization::WallExtractor extractor_;
  std::vector<std::optional<Look>> newest_;  ///< of each planar one
  localization::ScanPoints merged_;          ///< of them
  std::optional<Stamp> merged_at_;
};

}  // namespace madori::app
