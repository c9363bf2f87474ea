#include "app/log_player.hpp"

#include <chrono>
#include <cmath>

#include "localization/scan_points.hpp"
#include "localization/wall_extraction/wall_extraction.hpp"

namespace madori::app {
namespace {

/// A scan ready to be localized.
struct Seen {
  Stamp stamp{};
  localization::ScanPoints points;
  Point2<Base> sensor;
};

Seen seen(const sensors::ScanRecord& record, const LidarModel& /*lidar*/, const PoseMaker& maker) {
  if (record.odom_from_base) {
    (void)maker.on_odometry({record.scan.stamp, *record.odom_from_base});
  }
  return {record.scan.stamp, points_of(record), record.base_from_lidar.translation()};
}

Seen seen(const sensors::CloudRecord& record, const LidarModel& lidar, const PoseMaker& /*maker*/) {
  return {record.cloud.stamp, localization::extract_walls(sensors::cloud_in_base(record), lidar),
          record.base_from_lidar.translation()};
}

localization::Beams beams(const sensors::ScanRecord& /*record*/, const Seen& scan, const LidarModel& lidar) {
  return localization::beams_of(scan.points, scan.sensor, lidar.mounting.z_m);
}

localization::Beams beams(const sensors::CloudRecord& record, const Seen& /*scan*/, const LidarModel& lidar) {
  return localization::beams_of(sensors::cloud_in_base(record), lidar);
}

std::size_t lidar_of(const sensors::ScanRecord& record) {
  return record.scan.lidar;
}
std::size_t lidar_of(const sensors::CloudRecord& record) {
  return record.cloud.lidar;
}

}  // namespace

localization::ScanPoints points_of(const sensors::ScanRecord& record, double range_min_m) {
  if (!record.moved) return localization::scan_points(record.scan, record.base_from_lidar, range_min_m);
  localization::ScanPoints points;
  for (const CloudPoint& p : record.moved->points) {
    const Point2<Lidar> at{static_cast<double>(p.x_m), static_cast<double>(p.y_m)};
    if (!(std::hypot(at.x_m, at.y_m) >= range_min_m)) continue;
    const Point2<Base> seen_at = record.base_from_lidar * at;
    points.add(seen_at.x_m, seen_at.y_m);
  }
  return points;
}

PlayedLog play_log(sensors::LogReader& log, const LogLidars& lidars, const PoseMaker& maker,
                   const std::function<void(const PoseEstimate&)>& sink, const ScanSink& scans,
                   localization::MapLearner* learner) {
  PlayedLog played;
  const auto timed = [&](const auto& record) {
    ++played.scans;
    const LidarModel& lidar = lidars.at(lidar_of(record));
    const auto before = std::chrono::steady_clock::now();
    const Seen scan = seen(record, lidar, maker);
    const PoseEstimate estimate = maker.on_scan(scan.stamp, scan.points, scan.sensor);
    sink(estimate);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - before;
    played.scan_ms.push_back(took.count());
    if (scans) scans(scan.points, scan.sensor, estimate);
    if (learner != nullptr && learner->is_due(estimate)) learner->look(beams(record, scan, lidar), estimate);
  };
  while (const auto record = log.next()) {
    if (const auto* odometry = std::get_if<OdometryReading>(&*record)) {
      ++played.odometry_records;
      sink(maker.on_odometry(*odometry));
    } else if (const auto* scan = std::get_if<sensors::ScanRecord>(&*record)) {
      timed(*scan);
    } else {
      timed(std::get<sensors::CloudRecord>(*record));
    }
  }
  return played;
}

PlayedLog play_log(sensors::LogReader& log, const LogLidars& lidars, localization::Localizer& localizer,
                   const std::function<void(const PoseEstimate&)>& sink, const ScanSink& scans,
                   localization::MapLearner* learner) {
  const PoseMaker maker{[&](const OdometryReading& reading) { return localizer.on_odometry(reading); },
                        [&](Stamp stamp, const localization::ScanPoints& points, const Point2<Base>& sensor) {
                          return localizer.on_scan(stamp, points, sensor);
                        }};
  return play_log(log, lidars, maker, sink, scans, learner);
}

}  // namespace madori::app
