#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "app/cycle/pose_source.hpp"

namespace madori::bench {

/// A sweep as cycle and localization got it.
struct HeardSweep {
  PointCloud<Base> cloud;
  Transform2<Odom, Base> odom_from_base;  ///< at the cloud's stamp
};

/// The product's localization, that keeps a copy of what it was told in a step.
class ListeningPose final : public app::PoseSource {
 public:
  ListeningPose(std::unique_ptr<app::PoseSource> inner, std::vector<HeardSweep>& heard)
      : inner_(std::move(inner)), heard_(heard) {}

  void set_places(const std::vector<Point2<Map>>& drawn) override { inner_->set_places(drawn); }
  PoseEstimate on_odometry(const OdometryReading& reading) override { return inner_->on_odometry(reading); }
  void on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) override {
    heard_.push_back({cloud, odom_from_base});
    inner_->on_cloud(cloud, odom_from_base);
  }
  void set_pose(const Transform2<Map, Base>& map_from_base, const PoseSigma& sigma) override {
    inner_->set_pose(map_from_base, sigma);
  }
  void search_anew() override { inner_->search_anew(); }
  [[nodiscard]] bool is_thinking() const override { return inner_->is_thinking(); }
  void set_thinking(bool thinking) override { inner_->set_thinking(thinking); }
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return inner_->hypotheses(); }
  [[nodiscard]] std::shared_ptr<const localization::BentDrawing> bent() const override {
    return inner_->bent();
  }
  [[nodiscard]] std::shared_ptr<const localization::RememberedParts> remembered() const override {
    return inner_->remembered();
  }

 private:
  std::unique_ptr<app::PoseSource> inner_;
  std::vector<HeardSweep>& heard_;
};

}  // namespace madori::bench
