#include <fcntl.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <rosbag/bag.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/String.h>
#include <sys/stat.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "sensors/rosbag/bridge.hpp"
#include "sensors/rosbag/bridge_time.hpp"
#include "sensors/rosbag/velodyne_scan.hpp"

namespace madori::sensors::rosbag_bridge {

struct Output::State {
  rosbag::Bag bag;
  int descriptor = -1;  ///< of its file; the bag's own
};

namespace {

geometry_msgs::Pose to_message(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.x;
  message.position.y = pose.y;
  message.position.z = pose.z;
  message.orientation.x = pose.qx;
  message.orientation.y = pose.qy;
  message.orientation.z = pose.qz;
  message.orientation.w = pose.qw;
  return message;
}

/// The open descriptor of a file, which the library keeps to itself; -1 where it cannot be told.
int descriptor_of(const std::string& file) {
  struct stat wanted {};
  if (::stat(file.c_str(), &wanted) != 0) return -1;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", none)) {
    const int descriptor = std::atoi(entry.path().filename().c_str());
    struct stat there {};
    if (::fstat(descriptor, &there) == 0 && there.st_dev == wanted.st_dev && there.st_ino == wanted.st_ino)
      return descriptor;
  }
  return -1;
}

bool closes(rosbag::Bag& bag) {
  try {
    bag.close();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

Output::Output(const std::string& file) : state_(std::make_unique<State>()) {
  try {
    state_->bag.open(file, rosbag::bagmode::Write);
  } catch (...) {
    state_->descriptor = descriptor_of(file);
    close_anyhow();
    throw;
  }
  state_->bag.setCompression(rosbag::compression::LZ4);
  state_->descriptor = descriptor_of(file);
}

Output::~Output() {
  close_anyhow();
}

/// A bag that cannot be closed (the disk is full) would throw from its destructor and end the program: what
/// it still wants to write then goes nowhere. Where even that fails, its memory is given up instead.
void Output::close_anyhow() {
  if (closes(state_->bag)) return;
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  const bool diverted = nowhere >= 0 && state_->descriptor >= 0 && ::dup2(nowhere, state_->descriptor) >= 0;
  if (nowhere >= 0) ::close(nowhere);
  if (!diverted || !closes(state_->bag)) (void)state_.release();
}

void Output::write_twist(const std::string& topic, std::int64_t stamp_ns, double linear_mps,
                         double angular_radps) {
  geometry_msgs::Twist message;
  message.linear.x = linear_mps;
  message.angular.z = angular_radps;
  state_->bag.write(topic, to_time(stamp_ns), message);
}

void Output::write(const std::string& topic, std::int64_t stamp_ns, const Scan& scan) {
  sensor_msgs::LaserScan message;
  message.header.stamp = to_time(scan.stamp_ns);
  message.header.frame_id = scan.frame;
  message.angle_min = scan.angle_min;
  message.angle_increment = scan.angle_increment;
  message.angle_max = scan.angle_min + scan.angle_increment * (static_cast<float>(scan.ranges.size()) - 1.0F);
  message.time_increment = scan.time_increment;
  message.range_min = scan.range_min;
  message.range_max = scan.range_max;
  message.ranges = scan.ranges;
  message.intensities = scan.intensities;
  state_->bag.write(topic, to_time(stamp_ns), message);
}

void Output::write(const std::string& topic, const Cloud& cloud) {
  sensor_msgs::PointCloud2 message;
  message.header.stamp = to_time(cloud.stamp_ns);
  message.header.frame_id = cloud.frame;
  message.width = cloud.width;
  message.height = cloud.height;
  message.point_step = cloud.point_step;
  message.row_step = cloud.row_step;
  message.is_dense = 1;
  for (const Field& field : cloud.fields) {
    sensor_msgs::PointField entry;
    entry.name = field.name;
    entry.offset = field.offset;
    entry.datatype = field.type;
    entry.count = field.count;
    message.fields.push_back(entry);
  }
  message.data = cloud.data;
  state_->bag.write(topic, message.header.stamp, message);
}

void Output::write(const std::string& topic, std::int64_t stamp_ns, const std::string& frame,
                   const std::vector<Packet>& packets) {
  VelodyneScan message;
  message.header.stamp = to_time(stamp_ns);
  message.header.frame_id = frame;
  for (const Packet& packet : packets) {
    VelodynePacket entry;
    if (packet.bytes.size() != entry.data.size())
      throw std::runtime_error("a packet has " + std::to_string(packet.bytes.size()) + " bytes, not 1206");
    entry.stamp = to_time(packet.received_ns);
    std::copy(packet.bytes.begin(), packet.bytes.end(), entry.data.begin());
    message.packets.push_back(entry);
  }
  state_->bag.write(topic, message.header.stamp, message);
}

void Output::write_odometry(const std::string& topic, const Pose& pose) {
  nav_msgs::Odometry message;
  message.header.stamp = to_time(pose.stamp_ns);
  message.header.frame_id = "odom";
  message.child_frame_id = "base_link";
  message.pose.pose = to_message(pose);
  state_->bag.write(topic, message.header.stamp, message);
}

void Output::write_estimate(const std::string& topic, const Pose& pose) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.stamp = to_time(pose.stamp_ns);
  message.header.frame_id = "map";
  message.pose.pose = to_message(pose);
  if (pose.covariance.size() == message.pose.covariance.size())
    std::copy(pose.covariance.begin(), pose.covariance.end(), message.pose.covariance.begin());
  state_->bag.write(topic, message.header.stamp, message);
}

void Output::write_path(const std::string& topic, std::int64_t stamp_ns, const std::vector<Pose>& poses) {
  nav_msgs::Path message;
  message.header.stamp = to_time(stamp_ns);
  message.header.frame_id = "map";
  for (const Pose& pose : poses) {
    geometry_msgs::PoseStamped entry;
    entry.header = message.header;
    entry.pose = to_message(pose);
    message.poses.push_back(entry);
  }
  state_->bag.write(topic, message.header.stamp, message);
}

void Output::write_text(const std::string& topic, std::int64_t stamp_ns, const std::string& text) {
  std_msgs::String message;
  message.data = text;
  state_->bag.write(topic, to_time(stamp_ns), message);
}

void Output::write_frames(const std::string& topic, std::int64_t stamp_ns, const std::vector<FrameIn>& frames,
                          bool latched) {
  tf2_msgs::TFMessage message;
  for (const FrameIn& frame : frames) {
    geometry_msgs::TransformStamped entry;
    entry.header.stamp = to_time(frame.pose.stamp_ns);
    entry.header.frame_id = frame.parent;
    entry.child_frame_id = frame.child;
    const geometry_msgs::Pose pose = to_message(frame.pose);
    entry.transform.translation.x = pose.position.x;
    entry.transform.translation.y = pose.position.y;
    entry.transform.translation.z = pose.position.z;
    entry.transform.rotation = pose.orientation;
    message.transforms.push_back(entry);
  }
  boost::shared_ptr<ros::M_string> header;
  if (latched) {
    header = boost::make_shared<ros::M_string>();
    (*header)["topic"] = topic;
    (*header)["type"] = ros::message_traits::datatype(message);
    (*header)["md5sum"] = ros::message_traits::md5sum(message);
    (*header)["message_definition"] = ros::message_traits::definition(message);
    (*header)["latching"] = "1";
  }
  state_->bag.write(topic, to_time(stamp_ns), message, header);
}

void Output::close() {
  state_->bag.close();
}

}  // namespace madori::sensors::rosbag_bridge
