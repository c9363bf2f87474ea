#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sensors/log_record.hpp"
#include "sensors/which_lidar.hpp"

namespace madori::sensors::rosbag_bridge {
class Input;
}

namespace madori::sensors {

struct BagOptions {
  std::string scan_topic;            ///< empty: the bag's only one, or /scan
  std::string cloud_topic;           ///< empty: the bag's only one, or /velodyne_points
  std::string odometry_topic;        ///< empty: the bag's only one, or /odom
  std::vector<MountedLidar> lidars;  ///< among which each topic's is chosen; none: at the Base origin
};

/// Reads a ROS 1 bag: sensor_msgs/LaserScan, sensor_msgs/PointCloud2, nav_msgs/Odometry, in the order of
/// recording.
class BagReader final : public LogReader {
 public:
  /// Throws Error when the file is no readable bag, holds no such message, or several topics of a kind to
  /// choose from; next() does where it is not clear of which lidar a topic is.
  explicit BagReader(const std::filesystem::path& file, BagOptions options = {});
  ~BagReader() override;
  [[nodiscard]] std::optional<LogRecord> next() override;

 private:
  [[nodiscard]] const MountedLidar& lidar_of(bool planar, const std::string& topic, const std::string& frame);

  std::filesystem::path file_;
  BagOptions options_;
  std::unique_ptr<rosbag_bridge::Input> input_;
  std::map<std::pair<std::string, std::string>, MountedLidar> found_;  ///< by topic and frame
  std::deque<LogRecord> ready_;
};

}  // namespace madori::sensors
