#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "app/cycle/pose_source.hpp"
#include "app/pose/scan_maker.hpp"
#include "core/lidar_model.hpp"
#include "localization/localizer/localizer.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

struct LocalizerPoseOptions {
  localization::LocalizerOptions localizer = localization::driving_options();
  std::optional<localization::Memory> memory;  ///< of an earlier drive
  /// Sees the points on walls of every revolution (Base frame) and the pose there; nothing comes back.
  std::function<void(const localization::ScanPoints&, const PoseEstimate&)> onlooker;
  /// Sees every sweep whole, with its lidar and the pose there; nothing comes back.
  std::function<void(const PointCloud<Base>&, const LidarModel&, const PoseEstimate&)> sweep_onlooker;
};

/// The localizer as the cycle's pose source.
class LocalizerPose final : public PoseSource {
 public:
  LocalizerPose(const mapping::Walls& walls, std::vector<LidarModel> lidars,
                const LocalizerPoseOptions& options = {});

  void set_places(const std::vector<Point2<Map>>& drawn) override { localizer_.set_places(drawn); }
  PoseEstimate on_odometry(const OdometryReading& reading) override {
    return localizer_.on_odometry(reading);
  }
  void on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) override;
  void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) override {
    localizer_.set_pose(map_from_base, sigma);
  }
  void search_anew() override { localizer_.search_anew(); }
  [[nodiscard]] bool is_thinking() const override { return localizer_.is_thinking(); }
  void set_thinking(bool thinking) override { localizer_.set_thinking(thinking); }
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return localizer_.hypotheses(); }
  [[nodiscard]] std::shared_ptr<const localization::BentDrawing> bent() const override {
    return localizer_.bent();
  }
  [[nodiscard]] std::shared_ptr<const localization::RememberedParts> remembered() const override;

 private:
  void give(const ScanMaker::Scan& scan);
  void show(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base);

  LocalizerPoseOptions options_;
  ScanMaker scans_;
  PoseEstimate pose_;                     ///< at the last scan that was given
  Transform2<Odom, Base> pose_odometry_;  ///< odom_from_base there
  localization::Localizer localizer_;
};

}  // namespace madori::app
