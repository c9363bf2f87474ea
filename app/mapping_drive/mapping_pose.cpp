#include "app/mapping_drive/mapping_pose.hpp"

#include <utility>

namespace madori::app {

MappingPose::MappingPose(std::shared_ptr<MappingDesk> desk, std::vector<LidarModel> lidars)
    : desk_(std::move(desk)), scans_(std::move(lidars)) {}

PoseEstimate MappingPose::on_odometry(const OdometryReading& reading) {
  desk_->on_odometry(reading);
  PoseEstimate estimate;
  const auto newest = desk_->newest();
  if (newest) {
    estimate = newest->pose;
    estimate.map_from_base =
        newest->pose.map_from_base * (newest->odom_from_base.inverse() * reading.odom_from_base);
  }
  estimate.stamp = reading.stamp;
  const bool lost = desk_->progress().lost;
  estimate.health = {lost ? LocalizationState::Degraded : LocalizationState::Localized,
                     lost ? "the map does not go on here" : ""};
  return estimate;
}

void MappingPose::on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) {
  if (!scans_.looks(cloud.lidar)) return;
  const auto scan = scans_.on_cloud(cloud, odom_from_base);
  if (!scan) return;
  desk_->on_scan({scan->stamp, scans_.eye(), localization::weighty_points(scan->points)},
                 scan->odom_from_base);
}

}  // namespace madori::app
