#pragma once

#include <optional>

#include "sensors/rosbag/bag_bytes.hpp"
#include "sensors/rosbag/bridge.hpp"

namespace madori::sensors::rosbag_bridge {

/// A ROS message type by its name, and the MD5 sum of its definition.
struct MessageType {
  Kind kind;
  const char *name, *md5sum;
};
inline constexpr const char* kMultiEcho = "sensor_msgs/MultiEchoLaserScan";
inline constexpr MessageType kMessageTypes[]{
    {Kind::Scan, "sensor_msgs/LaserScan", "90c7ef2dc6895d81024acba2ac42f369"},
    {Kind::Cloud, "sensor_msgs/PointCloud2", "1158d486dd51d683ce2f1be655c3c181"},
    {Kind::Odometry, "nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7"},
    {Kind::Text, "std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1"},
    {Kind::Packets, "velodyne_msgs/VelodyneScan", "50804fc9533a0e579e6322c04ae70566"},
    {Kind::Scan, kMultiEcho, "6fefb0c6da89d7c8abe4b339f5c2f8fb"}};

/// Nothing for types that are not read.
[[nodiscard]] std::optional<Kind> kind_of(const std::string& type, const std::string& md5sum);

/// Messages from their bytes (ROS serialization: fields in order, little-endian, arrays behind a u32 count).
/// All throw std::runtime_error where the bytes end before the message does.
[[nodiscard]] Scan scan_from(Bytes message);
/// Of a MultiEchoLaserScan the first echo of each beam, without intensities; 0 where there is none.
[[nodiscard]] Scan first_echoes_from(Bytes message);
[[nodiscard]] std::int64_t header_stamp_ns(Bytes message);
[[nodiscard]] Cloud cloud_from(Bytes message);
[[nodiscard]] Pose odometry_from(Bytes message);
[[nodiscard]] std::string text_from(Bytes message);
[[nodiscard]] std::vector<Packet> packets_from(Bytes message);

}  // namespace madori::sensors::rosbag_bridge
