#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "core/frames.hpp"
#include "core/laser_scan.hpp"
#include "core/odometry.hpp"
#include "core/point_cloud.hpp"
#include "core/transform2.hpp"

namespace madori::sensors {

/// One 2D scan of a log.
struct ScanRecord {
  std::string source;  ///< FLASER, RLASER, ROBOTLASER1, or the topic
  LaserScan scan;      ///< Lidar frame
  Transform2<Base, Lidar> base_from_lidar;
  /// The vehicle's dead reckoning at the scan, where the log states it beside the scan.
  std::optional<Transform2<Odom, Base>> odom_from_base;
  /// The returns as they would have been seen at the scan's stamp, in the order of the beams; nothing where
  /// the sweep counts as instantaneous, or no odometry spans it.
  std::optional<PointCloud<Lidar>> moved;
};

/// One revolution of a 3D lidar of a log.
struct CloudRecord {
  std::string source;  ///< the kind of lidar, or the topic
  PointCloud<Lidar> cloud;
  Transform2<Base, Lidar> base_from_lidar;
  double lidar_height_m = 0.0;  ///< of the lidar above the floor
};

/// The cloud as the vehicle sees it: on the floor, z up.
[[nodiscard]] inline PointCloud<Base> cloud_in_base(const CloudRecord& record) {
  PointCloud<Base> cloud{record.cloud.stamp, record.cloud.points};
  for (CloudPoint& p : cloud.points) {
    const Point2<Base> q =
        record.base_from_lidar * Point2<Lidar>{static_cast<double>(p.x_m), static_cast<double>(p.y_m)};
    p.x_m = static_cast<float>(q.x_m);
    p.y_m = static_cast<float>(q.y_m);
    p.z_m += static_cast<float>(record.lidar_height_m);
  }
  return cloud;
}

using LogRecord = std::variant<OdometryReading, ScanRecord, CloudRecord>;

[[nodiscard]] inline Stamp stamp_of(const LogRecord& record) {
  if (const auto* scan = std::get_if<ScanRecord>(&record)) return scan->scan.stamp;
  if (const auto* cloud = std::get_if<CloudRecord>(&record)) return cloud->cloud.stamp;
  return std::get<OdometryReading>(record).stamp;
}

/// Told what was found out about a log, in words for people.
using LogRemark = std::function<void(const std::string&)>;

/// A log, read record by record; a log of any length needs the memory of a few records.
class LogReader {
 public:
  LogReader() = default;
  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;
  virtual ~LogReader() = default;

  /// The next record, nothing at the end. Throws Error with the place in the file where the log is damaged.
  [[nodiscard]] virtual std::optional<LogRecord> next() = 0;
};

}  // namespace madori::sensors
