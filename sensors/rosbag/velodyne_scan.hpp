#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>

#include <boost/array.hpp>
#include <cstdint>
#include <vector>

/// velodyne_msgs/VelodyneScan and VelodynePacket, which Debian does not package: what velodyne_pointcloud,
/// rviz and Foxglove's converters read. C++17, for the bridge alone.
namespace madori::sensors::rosbag_bridge {

struct VelodynePacket {
  ros::Time stamp;
  boost::array<std::uint8_t, 1206> data;
};

struct VelodyneScan {
  std_msgs::Header header;
  std::vector<VelodynePacket> packets;
};

}  // namespace madori::sensors::rosbag_bridge

namespace ros::message_traits {

template <>
struct MD5Sum<madori::sensors::rosbag_bridge::VelodyneScan> {
  static const char* value() { return "50804fc9533a0e579e6322c04ae70566"; }
  template <class M>
  static const char* value(const M&) {
    return value();
  }
};
template <>
struct DataType<madori::sensors::rosbag_bridge::VelodyneScan> {
  static const char* value() { return "velodyne_msgs/VelodyneScan"; }
  template <class M>
  static const char* value(const M&) {
    return value();
  }
};
template <>
struct Definition<madori::sensors::rosbag_bridge::VelodyneScan> {
  static const char* value() {
    return "Header header\n"
           "VelodynePacket[] packets\n"
           "================================================================================\n"
           "MSG: std_msgs/Header\n"
           "uint32 seq\n"
           "time stamp\n"
           "string frame_id\n"
           "================================================================================\n"
           "MSG: velodyne_msgs/VelodynePacket\n"
           "time stamp\n"
           "uint8[1206] data\n";
  }
  template <class M>
  static const char* value(const M&) {
    return value();
  }
};
template <>
struct HasHeader<madori::sensors::rosbag_bridge::VelodyneScan> : TrueType {};

}  // namespace ros::message_traits

namespace ros::serialization {

template <>
struct Serializer<madori::sensors::rosbag_bridge::VelodynePacket> {
  template <class Stream, class T>
  static void allInOne(Stream& stream, T m) {
    stream.next(m.stamp);
    stream.next(m.data);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};
template <>
struct Serializer<madori::sensors::rosbag_bridge::VelodyneScan> {
  template <class Stream, class T>
  static void allInOne(Stream& stream, T m) {
    stream.next(m.header);
    stream.next(m.packets);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

}  // namespace ros::serialization
