#pragma once

#include <filesystem>
#include <memory>

#include "core/wheels.hpp"
#include "sensors/log_record.hpp"
#include "sensors/rosbag/reader.hpp"
#include "sensors/steady_time.hpp"

namespace madori::sensors {

struct LogOptions {
  std::filesystem::path wheels;             ///< `time_s,left_rad,right_rad`, beside a .pcap
  WheelGeometry geometry;                   ///< what the wheels' angles mean
  Transform2<Base, Lidar> base_from_lidar;  ///< mounting, for .pcap; CARMEN logs tell it themselves
  double lidar_height_m = 0.0;              ///< of the lidar above the floor
  std::size_t lidar = 0;                    ///< its place among the vehicle's
  bool deskew = true;                       ///< move a cloud's points to its stamp, where there is odometry
  BagOptions bag;                           ///< topics and lidars; where it names none, that from above
  LogRemark remark;                         ///< may be empty; is told the file, too
};

/// Opens a log by its extension: .log, .clf, .carmen (CARMEN), .bag (ROS 1), .pcap, .pcapng (VLP-16, with
/// wheels). Bags and captures give their records in the order of time, CARMEN logs in the order of the file.
/// Where a clock was set back, time goes on (SteadyTimeReader).
/// Throws Error with the file, the cause and the mend.
[[nodiscard]] std::unique_ptr<LogReader> open_log(const std::filesystem::path& file,
                                                  const LogOptions& options = {});

}  // namespace madori::sensors
