#pragma once

#include <functional>

#include "core/lidar_model.hpp"
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

/// Runs a log through it in the order of its records, and hands out the pose of every record. `lidar` is the
/// one whose clouds the log holds. `learner`, where there is one, looks at every scan that is due.
PlayedLog play_log(sensors::LogReader& log, const LidarModel& lidar, const PoseMaker& maker,
                   const std::function<void(const PoseEstimate&)>& sink, const ScanSink& scans = {},
                   localization::MapLearner* learner = nullptr);
PlayedLog play_log(sensors::LogReader& log, const LidarModel& lidar, localization::Localizer& localizer,
                   const std::function<void(const PoseEstimate&)>& sink, const ScanSink& scans = {},
                   localization::MapLearner* learner = nullptr);

}  // namespace madori::app
