#pragma once

#include <functional>

#include "app/cycle/pose_source.hpp"
#include "localization/wall_extraction/wall_extraction.hpp"
#include "localization/wall_tracker/wall_tracker.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

struct DrawingPoseOptions {
  localization::CloudWallOptions walls;
  localization::WallTrackerOptions tracker;
  /// Sees the points on walls of every revolution (Base frame) and the pose there; nothing comes back.
  std::function<void(const localization::ScanPoints&, const PoseEstimate&)> onlooker;
};

/// The wall tracker as the cycle's pose source: VLP-16 revolutions become points on walls.
class DrawingPose final : public PoseSource {
 public:
  explicit DrawingPose(const mapping::Walls& walls, const DrawingPoseOptions& options = {})
      : options_(options), tracker_(walls, options.tracker) {}

  PoseEstimate on_odometry(const OdometryReading& reading) override { return tracker_.on_odometry(reading); }
  void on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& /*odom_from_base*/) override {
    const auto points = localization::extract_walls(cloud, options_.walls);
    const PoseEstimate pose = tracker_.on_scan(cloud.stamp, points);
    if (options_.onlooker) options_.onlooker(points, pose);
  }
  void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) override {
    tracker_.set_pose(map_from_base, sigma);
  }
  void search_anew() override { tracker_.search_anew(); }
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return tracker_.hypotheses(); }

 private:
  DrawingPoseOptions options_;
  localization::WallTracker tracker_;
};

}  // namespace madori::app
