#pragma once

#include <functional>

#include "app/cycle/pose_source.hpp"
#include "localization/localizer/localizer.hpp"
#include "localization/wall_extraction/wall_extraction.hpp"
#include "mapping/wall_map/wall.hpp"
#include "planning/obstacle_check/obstacle_field.hpp"

namespace madori::app {

struct LocalizerPoseOptions {
  localization::CloudWallOptions walls;
  localization::LocalizerOptions localizer = localization::driving_options();
  /// Sees the points on walls of every revolution (Base frame) and the pose there; nothing comes back.
  std::function<void(const localization::ScanPoints&, const PoseEstimate&)> onlooker;
};

/// The localizer as the cycle's pose source: revolutions become points on walls.
class LocalizerPose final : public PoseSource {
 public:
  LocalizerPose(const mapping::Walls& walls, const planning::SensorView& lidar,
                const LocalizerPoseOptions& options = {})
      : options_(options), lidar_{lidar.x_m, lidar.y_m}, localizer_(walls, std::nullopt, options.localizer) {
    options_.walls.sensor_height_m = lidar.z_m;
    options_.walls.max_elevation_rad = lidar.max_elevation_rad;
  }

  PoseEstimate on_odometry(const OdometryReading& reading) override {
    return localizer_.on_odometry(reading);
  }
  void on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& /*odom_from_base*/) override {
    const auto points = localization::extract_walls(cloud, options_.walls);
    const PoseEstimate pose = localizer_.on_scan(cloud.stamp, points, lidar_);
    if (options_.onlooker) options_.onlooker(points, pose);
  }
  void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) override {
    localizer_.set_pose(map_from_base, sigma);
  }
  void search_anew() override { localizer_.search_anew(); }
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return localizer_.hypotheses(); }
  [[nodiscard]] std::shared_ptr<const localization::BentDrawing> bent() const override {
    return localizer_.bent();
  }

 private:
  LocalizerPoseOptions options_;
  Point2<Base> lidar_;  ///< where it sits
  localization::Localizer localizer_;
};

}  // namespace madori::app
