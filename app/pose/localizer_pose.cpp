#include "app/pose/localizer_pose.hpp"

#include <algorithm>
#include <utility>

#include "app/cycle/stages.hpp"

namespace madori::app {
namespace {

constexpr double kMergeS = 0.095;  ///< between two merged scans: no lidar here turns evenly at 10 Hz
constexpr double kStillTrueS = 0.3;

}  // namespace

Point2<Base> LocalizerPose::eye(const std::vector<LidarModel>& lidars) {
  double looking = 0.0;
  for (std::size_t i = 0; i < lidars.size(); ++i) looking += tells_place(lidars, i) ? 1.0 : 0.0;
  Point2<Base> middle;
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    if (!tells_place(lidars, i)) continue;
    middle.x_m += lidars[i].mounting.x_m / looking;
    middle.y_m += lidars[i].mounting.y_m / looking;
  }
  return middle;
}

LocalizerPose::LocalizerPose(const mapping::Walls& walls, std::vector<LidarModel> lidars,
                             const LocalizerPoseOptions& options)
    : options_(options),
      lidars_(std::move(lidars)),
      looks_(lidars_.size(), false),
      eye_(eye(lidars_)),
      newest_(lidars_.size()),
      localizer_(walls, std::nullopt, options.localizer) {
  for (std::size_t i = 0; i < lidars_.size(); ++i) looks_[i] = tells_place(lidars_, i);
  if (options_.memory) localizer_.recall(*std::exchange(options_.memory, std::nullopt));
}

std::shared_ptr<const localization::RememberedParts> LocalizerPose::remembered() const {
  auto parts = localizer_.remembered();
  return parts ? std::make_shared<const localization::RememberedParts>(*std::move(parts)) : nullptr;
}

void LocalizerPose::give(Stamp stamp, const localization::ScanPoints& points,
                         const Transform2<Odom, Base>& odom_from_base) {
  pose_ = localizer_.on_scan(stamp, points, eye_);
  pose_odometry_ = odom_from_base;
  if (options_.onlooker) options_.onlooker(points, pose_);
}

/// At the pose of the last scan, and what the wheels did since.
void LocalizerPose::show(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) {
  if (!options_.sweep_onlooker) return;
  PoseEstimate pose = pose_;
  pose.stamp = cloud.stamp;
  pose.map_from_base = pose_.map_from_base * (pose_odometry_.inverse() * odom_from_base);
  options_.sweep_onlooker(cloud, lidars_[cloud.lidar], pose);
}

void LocalizerPose::give_merged(Stamp now, const Transform2<Odom, Base>& odom_from_base) {
  merged_.clear();
  for (const auto& look : newest_) {
    if (!look || to_seconds(now - look->stamp) > kStillTrueS) continue;
    const auto moved = odom_from_base.inverse() * look->odom_from_base;
    for (std::size_t k = 0; k < look->points.size(); ++k) {
      const Point2<Base> at = moved * look->points.point(k);
      merged_.add(at.x_m, at.y_m);
    }
  }
  given_ = now;
  give(now, merged_, odom_from_base);
}

void LocalizerPose::on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) {
  if (!looks_[cloud.lidar]) return;
  const LidarModel& lidar = lidars_[cloud.lidar];
  const auto& points = extractor_.extract(cloud, lidar, options_.walls);
  if (lidar.kind == LidarKind::Spinning) {
    give(cloud.stamp, points, odom_from_base);
    return show(cloud, odom_from_base);
  }
  Look& look = newest_[cloud.lidar] ? *newest_[cloud.lidar] : newest_[cloud.lidar].emplace();
  look.stamp = cloud.stamp;
  look.points = points;
  look.odom_from_base = odom_from_base;
  const double since_s = given_ ? to_seconds(cloud.stamp - *given_) : kMergeS;
  if (since_s >= kMergeS || since_s < -kStillTrueS) give_merged(cloud.stamp, odom_from_base);
  show(cloud, odom_from_base);
}

}  // namespace madori::app
