#include "app/log_player.hpp"

#include <chrono>

#include "localization/scan_points.hpp"
#include "localization/wall_extraction/wall_extraction.hpp"

namespace madori::app {
namespace {

PoseEstimate locate(const sensors::ScanRecord& record, localization::Localizer& localizer) {
  if (record.odom_from_base) {
    (void)localizer.on_odometry({record.scan.stamp, *record.odom_from_base});
  }
  return localizer.on_scan(record.scan.stamp, localization::scan_points(record.scan, record.base_from_lidar),
                           record.base_from_lidar.translation());
}

PoseEstimate locate(const sensors::CloudRecord& record, localization::Localizer& localizer) {
  return localizer.on_scan(record.cloud.stamp, localization::extract_walls(sensors::cloud_in_base(record)),
                           record.base_from_lidar.translation());
}

}  // namespace

PlayedLog play_log(sensors::LogReader& log, localization::Localizer& localizer,
                   const std::function<void(const PoseEstimate&)>& sink) {
  PlayedLog played;
  const auto timed = [&](const auto& record) {
    ++played.scans;
    const auto before = std::chrono::steady_clock::now();
    sink(locate(record, localizer));
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - before;
    played.scan_ms.push_back(took.count());
  };
  while (const auto record = log.next()) {
    if (const auto* odometry = std::get_if<OdometryReading>(&*record)) {
      ++played.odometry_records;
      sink(localizer.on_odometry(*odometry));
    } else if (const auto* scan = std::get_if<sensors::ScanRecord>(&*record)) {
      timed(*scan);
    } else {
      timed(std::get<sensors::CloudRecord>(*record));
    }
  }
  return played;
}

}  // namespace madori::app
