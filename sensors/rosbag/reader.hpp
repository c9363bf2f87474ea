#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <string>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "sensors/log_record.hpp"

namespace madori::sensors::rosbag_bridge {
class Input;
}

namespace madori::sensors {

struct BagOptions {
  std::string scan_topic;      ///< empty: the bag's only one, or /scan
  std::string cloud_topic;     ///< empty: the bag's only one, or /velodyne_points
  std::string odometry_topic;  ///< empty: the bag's only one, or /odom
  Transform2<Base, Lidar> base_from_lidar;
  double lidar_height_m = 0.0;
};

/// Reads a ROS 1 bag: sensor_msgs/LaserScan, sensor_msgs/PointCloud2, nav_msgs/Odometry, in the order of
/// recording.
class BagReader final : public LogReader {
 public:
  /// Throws Error when the file is no readable bag, holds no such message, or several topics of a kind to
  /// choose from.
  explicit BagReader(const std::filesystem::path& file, BagOptions options = {});
  ~BagReader() override;
  [[nodiscard]] std::optional<LogRecord> next() override;

 private:
  std::filesystem::path file_;
  BagOptions options_;
  std::unique_ptr<rosbag_bridge::Input> input_;
  std::deque<LogRecord> ready_;
};

}  // namespace madori::sensors
