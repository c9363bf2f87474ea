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

/// As far as a recording may disorder its messages.
inline constexpr Duration kBagDisorder = std::chrono::milliseconds(300);

struct BagOptions {
  std::string scan_topic;            ///< empty: the bag's only one, or /scan
  std::string cloud_topic;           ///< empty: the bag's only one, or /velodyne_points
  std::string odometry_topic;        ///< empty: the bag's only one, or /odom
  std::vector<MountedLidar> lidars;  ///< among which each topic's is chosen; none: at the Base origin
  LogRemark remark;                  ///< may be empty
};

/// Reads a ROS 1 bag: sensor_msgs/LaserScan (of MultiEchoLaserScan the first echoes),
/// sensor_msgs/PointCloud2, nav_msgs/Odometry, in the order of recording. Where topics are stamped by two
/// clocks, which the times of recording tell, all come by that of the odometry.
class BagReader final : public LogReader {
 public:
  /// Throws Error when the file is no readable bag, holds no such message, several topics of a kind to
  /// choose from, or such of two clocks that do not go alike; next() does where it is not clear of which
  /// lidar a topic is.
  explicit BagReader(const std::filesystem::path& file, BagOptions options = {});
  ~BagReader() override;
  [[nodiscard]] std::optional<LogRecord> next() override;

 private:
  void put_on_one_clock(const std::vector<std::string>& topics);
  [[nodiscard]] Stamp stamp_of_topic(const std::string& topic, std::int64_t stamp_ns) const;
  [[nodiscard]] const MountedLidar& lidar_of(bool planar, const std::string& topic, const std::string& frame);

  std::filesystem::path file_;
  BagOptions options_;
  std::unique_ptr<rosbag_bridge::Input> input_;
  std::map<std::pair<std::string, std::string>, MountedLidar> found_;  ///< by topic and frame
  std::map<std::string, Duration> moved_;                              ///< added to a topic's stamps
  std::deque<LogRecord> ready_;
};

}  // namespace madori::sensors
