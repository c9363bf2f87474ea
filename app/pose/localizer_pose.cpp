#include "app/pose/localizer_pose.hpp"

#include <utility>

namespace madori::app {

LocalizerPose::LocalizerPose(const mapping::Walls& walls, std::vector<LidarModel> lidars,
                             const LocalizerPoseOptions& options)
    : options_(options), scans_(std::move(lidars)), localizer_(walls, std::nullopt, options.localizer) {
  if (options_.memory) localizer_.recall(*std::exchange(options_.memory, std::nullopt));
}

std::shared_ptr<const localization::RememberedParts> LocalizerPose::remembered() const {
  auto parts = localizer_.remembered();
  return parts ? std::make_shared<const localization::RememberedParts>(*std::move(parts)) : nullptr;
}

void LocalizerPose::give(const ScanMaker::Scan& scan) {
  pose_ = localizer_.on_scan(scan.stamp, scan.points, scans_.eye());
  pose_odometry_ = scan.odom_from_base;
  if (options_.onlooker) options_.onlooker(scan.points, pose_);
}

/// At the pose of the last scan, and what the wheels did since.
void LocalizerPose::show(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) {
  if (!options_.sweep_onlooker) return;
  PoseEstimate pose = pose_;
  pose.stamp = cloud.stamp;
  pose.map_from_base = pose_.map_from_base * (pose_odometry_.inverse() * odom_from_base);
  options_.sweep_onlooker(cloud, scans_.lidars()[cloud.lidar], pose);
}

void LocalizerPose::on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) {
  if (!scans_.looks(cloud.lidar)) return;
  if (const auto scan = scans_.on_cloud(cloud, odom_from_base)) give(*scan);
  show(cloud, odom_from_base);
}

}  // namespace madori::app
