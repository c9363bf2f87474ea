#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/laser_scan.hpp"
#include "core/odometry.hpp"
#include "core/path.hpp"
#include "core/point_cloud.hpp"
#include "core/pose_estimate.hpp"
#include "core/velocity_command.hpp"
#include "sensors/raw_packet.hpp"

namespace madori::sensors::rosbag_bridge {
class Output;
}

namespace madori::sensors {

/// A frame that is mounted on another, at z above it and turned about it.
struct MountedFrame {
  std::string parent, child;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, yaw_rad = 0.0;
};

/// Writes a ROS 1 bag, packed by LZ4, that Foxglove, PlotJuggler and rviz open. Every function throws Error
/// (disk full, no permission).
class BagWriter {
 public:
  explicit BagWriter(const std::filesystem::path& file);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// In what frames the vehicle's lidars tell what they see, by their places among them; "lidar" where that
  /// is not said.
  void set_lidar_frames(std::vector<std::string> frames) { lidar_frames_ = std::move(frames); }

  void write(const std::string& topic, const LaserScan& scan);  ///< sensor_msgs/LaserScan
  /// The same, as a message of another time than the scan's own, which stands in its header.
  void write(const std::string& topic, const LaserScan& scan, Stamp recorded);
  void write(const std::string& topic, const VelocityCommand& command, Stamp stamp);  ///< geometry_msgs/Twist
  void write(const std::string& topic, const PointCloud<Lidar>& cloud);  ///< sensor_msgs/PointCloud2
  /// velodyne_msgs/VelodyneScan: data packets of a VLP-16 as they came.
  void write(const std::string& topic, const std::vector<RawPacket>& packets, std::size_t lidar, Stamp stamp);
  void write(const std::string& topic, const OdometryReading& reading);  ///< nav_msgs/Odometry
  void write(const std::string& topic,
             const PoseEstimate& estimate);  ///< geometry_msgs/PoseWithCovarianceStamped
  void write(const std::string& topic, const Path& path, Stamp stamp);         ///< nav_msgs/Path
  void write(const std::string& topic, const std::string& text, Stamp stamp);  ///< std_msgs/String
  /// tf2_msgs/TFMessage: where the vehicle is, odom in map and base_link in odom.
  void write_vehicle_frames(const std::string& topic, const PoseEstimate& pose,
                            const OdometryReading& odometry);
  /// tf2_msgs/TFMessage, latched: what does not move.
  void write_mounted_frames(const std::string& topic, const std::vector<MountedFrame>& frames, Stamp stamp);
  /// Writes the index. The destructor does so too, but cannot tell that it failed.
  void close();

 private:
  template <class Action>
  void guarded(Action action);

  [[nodiscard]] std::string frame_of(std::size_t lidar) const;

  std::filesystem::path file_;
  std::vector<std::string> lidar_frames_;
  std::unique_ptr<rosbag_bridge::Output> output_;
};

}  // namespace madori::sensors
