#include "app/pose/scan_maker.hpp"

#include <utility>

#include "app/cycle/stages.hpp"

namespace madori::app {
namespace {

constexpr double kMergeS = 0.095;  ///< between two merged scans: no lidar here turns evenly at 10 Hz
constexpr double kStillTrueS = 0.3;

}  // namespace

Point2<Base> ScanMaker::eye(const std::vector<LidarModel>& lidars) {
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

ScanMaker::ScanMaker(std::vector<LidarModel> lidars)
    : lidars_(std::move(lidars)), looks_(lidars_.size(), false), eye_(eye(lidars_)), newest_(lidars_.size()) {
  for (std::size_t i = 0; i < lidars_.size(); ++i) looks_[i] = tells_place(lidars_, i);
}

void ScanMaker::merge(Stamp now, const Transform2<Odom, Base>& odom_from_base) {
  merged_.clear();
  for (const auto& look : newest_) {
    if (!look || to_seconds(now - look->stamp) > kStillTrueS) continue;
    const auto moved = odom_from_base.inverse() * look->odom_from_base;
    for (std::size_t k = 0; k < look->points.size(); ++k) {
      const Point2<Base> at = moved * look->points.point(k);
      merged_.add(at.x_m, at.y_m);
    }
  }
  merged_at_ = now;
}

std::optional<ScanMaker::Scan> ScanMaker::on_cloud(const PointCloud<Base>& cloud,
                                                   const Transform2<Odom, Base>& odom_from_base) {
  const LidarModel& lidar = lidars_[cloud.lidar];
  const auto& points = extractor_.extract(cloud, lidar);
  if (lidar.kind == LidarKind::Spinning) return Scan{cloud.stamp, points, odom_from_base};
  Look& look = newest_[cloud.lidar] ? *newest_[cloud.lidar] : newest_[cloud.lidar].emplace();
  look.stamp = cloud.stamp;
  look.points = points;
  look.odom_from_base = odom_from_base;
  const double since_s = merged_at_ ? to_seconds(cloud.stamp - *merged_at_) : kMergeS;
  if (since_s < kMergeS && since_s >= -kStillTrueS) return std::nullopt;
  merge(cloud.stamp, odom_from_base);
  return Scan{cloud.stamp, merged_, odom_from_base};
}

}  // namespace madori::app
