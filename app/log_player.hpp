#pragma once

#include <functional>

#include "app/log_options.hpp"
#include "core/pose_estimate.hpp"
#include "localization/localizer/localizer.hpp"
#include "localization/ndt_map/map_learner.hpp"
#include "sensors/log_record.hpp"

namespace madori::app {

/// What a log held, and what it cost.
struct PlayedLog {
  int scans = 0;
  int odometry_records = 0;
  std::vector<double> scan_ms;  ///< time of each scan's step
};

/// Sees the wall points of every scan (Base frame), where the lidar sits, and the scan's pose.
using ScanSink =
    std::function<void(const localization::ScanPoints&, const Point2<Base>&, const PoseEstimate&)>;

/// Whoever makes poses of odometry and scans (Base frame; where the lidar sits).
struct PoseMaker {
  std::function<PoseEstimate(const OdometryReading&)> on_odometry;
  std::function<PoseEstimate(Stamp, const localization::ScanPoints&, const Point2<Base>&)> on_scan;
};

/// The returns of a scan, Base frame: where they would have been seen at its stamp, as far as that is known.
/// Such below `range_min_m` are left out.
[[nodiscard]] localization::ScanPoints points_of(const sensors::ScanRecord& record,
                                                 double range_min_m = 0.05);

/// Runs a log through it in the order of its records, and hands out the pose of every record. `lidars` are
/// those whose sweeps the log holds. `learner`, where there is one, looks at every scan that is due.
PlayedLog play_log(sensors::LogReader& log, const LogLidars& lidars, const PoseMaker& maker,
                   const std::function<void(const PoseEstimate&)>& sink, const ScanSink& scans = {},
                   localization::MapLearner* learner = nullptr);
PlayedLog play_log(sensors::LogReader& log, const LogLidars& lidars, localization::Localizer& localizer,
                   const std::function<void(const PoseEstimate&)>& sink, const ScanSink& scans = {},
                   localization::MapLearner* learner = nullptr);

}  // namespace madori::app
