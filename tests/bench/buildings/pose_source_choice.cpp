#include "tests/bench/buildings/pose_source_choice.hpp"

#include <utility>

#include "localization/wall_extraction/wall_extraction.hpp"
#include "tests/bench/buildings/trial_localizer.hpp"
#include "tests/bench/buildings/wall_scanner.hpp"

namespace madori::bench {
namespace {

/// Either lidar's points on walls to a localizer.
class ChosenSource final : public app::PoseSource {
 public:
  ChosenSource(std::unique_ptr<TrialLocalizer> localizer, bool scans, const app::SiteForDriving& site,
               const simulation::Factory& factory)
      : localizer_(std::move(localizer)),
        scans_(scans),
        lidar_(site.config.lidars.front()),
        factory_(factory),
        scanner_(site.walls.size()) {}

  void set_places(const std::vector<Point2<Map>>& drawn) override { localizer_->set_places(drawn); }
  PoseEstimate on_odometry(const OdometryReading& reading) override {
    const PoseEstimate pose = localizer_->on_odometry(reading);
    if (!scans_ || factory_.now() <= seen_) return pose;
    seen_ = factory_.now();
    scanner_.moved(seen_, factory_.truth().building_from_base);
    const auto scans = scanner_.take(factory_.world(), factory_.bodies());
    for (const auto& [stamp, points] : scans) localizer_->on_scan(stamp, points, scanner_.place());
    return scans.empty() ? pose : localizer_->on_odometry(reading);
  }
  void on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& /*odom_from_base*/) override {
    if (!scans_)
      localizer_->on_scan(cloud.stamp, localization::extract_walls(cloud, lidar_),
                          {lidar_.mounting.x_m, lidar_.mounting.y_m});
  }
  void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) override {
    localizer_->set_pose(map_from_base, sigma);
  }
  void search_anew() override { localizer_->search_anew(); }
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return localizer_->hypotheses(); }
  [[nodiscard]] std::shared_ptr<const localization::BentDrawing> bent() const override {
    return localizer_->bent();
  }

 private:
  std::unique_ptr<TrialLocalizer> localizer_;
  bool scans_;
  LidarModel lidar_;
  const simulation::Factory& factory_;
  WallScanner scanner_;
  Stamp seen_{};
};

/// The true pose, as if the drawing were right: what planning and control make of the building by themselves.
class TrueSource final : public app::PoseSource {
 public:
  explicit TrueSource(const simulation::Factory& factory) : factory_(factory) {}

  PoseEstimate on_odometry(const OdometryReading& reading) override {
    constexpr double kVariance = 1e-6;
    const auto pose = factory_.truth().map_from_base;
    return {reading.stamp, pose, kVariance * Eigen::Matrix3d::Identity(), {LocalizationState::Localized, ""}};
  }
  void on_cloud(const PointCloud<Base>& /*cloud*/,
                const Transform2<Odom, Base>& /*odom_from_base*/) override {}
  void set_pose(const Transform2<Map, Base>& /*map_from_base*/, const PoseSigma& /*sigma*/) override {}
  void search_anew() override {}
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return {}; }

 private:
  const simulation::Factory& factory_;
};

}  // namespace

std::unique_ptr<app::PoseSource> make_pose_source(const std::string& name, const std::string& sensor,
                                                  const app::SiteForDriving& site,
                                                  const simulation::Factory& factory) {
  if (name == kTruth) return std::make_unique<TrueSource>(factory);
  return std::make_unique<ChosenSource>(make_trial_localizer(name, site.walls), sensor == "scan", site,
                                        factory);
}

}  // namespace madori::bench
