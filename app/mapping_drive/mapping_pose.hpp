#pragma once

#include <memory>

#include "app/cycle/pose_source.hpp"
#include "app/mapping_drive/mapping_desk.hpp"
#include "app/pose/scan_maker.hpp"

namespace madori::app {

/// The mapper as the cycle's pose source: its newest pose, carried on by the wheels. Map frame: where the
/// drive began. Not deterministic: when the mapper's word comes depends on the computer.
class MappingPose final : public PoseSource {
 public:
  MappingPose(std::shared_ptr<MappingDesk> desk, std::vector<LidarModel> lidars);

  PoseEstimate on_odometry(const OdometryReading& reading) override;
  void on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) override;
  /// There is no drawing on which a person could say a place.
  void set_pose(const Transform2<Map, Base>& /*map_from_base*/, const PoseSigma& /*sigma*/) override {}
  void search_anew() override {}
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return {}; }

 private:
  std::shared_ptr<MappingDesk> desk_;
  ScanMaker scans_;
};

}  // namespace madori::app
