#include "sensors/rosbag/bridge.hpp"

#include <fcntl.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
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

#include "sensors/rosbag/velodyne_scan.hpp"

namespace madori::sensors::rosbag_bridge {
namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::int64_t to_ns(const ros::Time& time) {
  return static_cast<std::int64_t>(time.sec) * kNanoseconds + static_cast<std::int64_t>(time.nsec);
}
/// Bags know no time before 1970 and none of zero.
ros::Time to_time(std::int64_t stamp_ns) {
  const std::int64_t bounded = std::max<std::int64_t>(stamp_ns, 1);
  return ros::Time(static_cast<std::uint32_t>(bounded / kNanoseconds),
                   static_cast<std::uint32_t>(bounded % kNanoseconds));
}

template <class Message>
bool is(const std::string& type) {
  return type == ros::message_traits::datatype<Message>();
}

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

Scan from_message(const sensor_msgs::LaserScan& m) {
  return {to_ns(m.header.stamp), m.header.frame_id, m.angle_min, m.angle_increment, m.time_increment,
          m.range_min,           m.range_max,       m.ranges,    m.intensities};
}

Cloud from_message(const sensor_msgs::PointCloud2& m) {
  Cloud cloud{to_ns(m.header.stamp),
              m.header.frame_id,
              m.width,
              m.height,
              m.point_step,
              m.row_step,
              m.is_bigendian != 0,
              {},
              m.data};
  for (const auto& field : m.fields)
    cloud.fields.push_back({field.name, field.offset, field.count, field.datatype});
  return cloud;
}

std::vector<Packet> from_message(const VelodyneScan& m) {
  std::vector<Packet> packets;
  packets.reserve(m.packets.size());
  for (const VelodynePacket& p : m.packets)
    packets.push_back({to_ns(p.stamp), {p.data.begin(), p.data.end()}});
  return packets;
}

Pose from_message(const nav_msgs::Odometry& m) {
  const auto& [position, orientation] = std::tie(m.pose.pose.position, m.pose.pose.orientation);
  return {to_ns(m.header.stamp), position.x,    position.y,    position.z, orientation.x,
          orientation.y,         orientation.z, orientation.w, {}};
}

}  // namespace

struct Input::State {
  rosbag::Bag bag;
  std::unique_ptr<rosbag::View> view;
  rosbag::View::iterator at;
};

Input::Input(const std::string& file) : state_(std::make_unique<State>()) {
  state_->bag.open(file, rosbag::bagmode::Read);
}
Input::~Input() = default;

std::vector<Topic> Input::topics() const {
  std::vector<Topic> topics;
  rosbag::View everything(state_->bag);
  for (const rosbag::ConnectionInfo* connection : everything.getConnections()) {
    Topic topic{connection->topic, Kind::Scan, 0};
    if (is<sensor_msgs::PointCloud2>(connection->datatype))
      topic.kind = Kind::Cloud;
    else if (is<nav_msgs::Odometry>(connection->datatype))
      topic.kind = Kind::Odometry;
    else if (is<std_msgs::String>(connection->datatype))
      topic.kind = Kind::Text;
    else if (!is<sensor_msgs::LaserScan>(connection->datatype))
      continue;
    const bool known =
        std::any_of(topics.begin(), topics.end(), [&](const Topic& t) { return t.name == topic.name; });
    if (known) continue;
    topic.messages = rosbag::View(state_->bag, rosbag::TopicQuery(topic.name)).size();
    topics.push_back(topic);
  }
  return topics;
}

void Input::choose(const std::vector<std::string>& topics) {
  state_->view = std::make_unique<rosbag::View>(state_->bag, rosbag::TopicQuery(topics));
  state_->at = state_->view->begin();
}

bool Input::next(const Sinks& sinks) {
  if (!state_->view || state_->at == state_->view->end()) return false;
  const rosbag::MessageInstance message = *state_->at;
  ++state_->at;
  if (const auto scan = message.instantiate<sensor_msgs::LaserScan>())
    sinks.scan(message.getTopic(), from_message(*scan));
  else if (const auto cloud = message.instantiate<sensor_msgs::PointCloud2>())
    sinks.cloud(message.getTopic(), from_message(*cloud));
  else if (const auto odometry = message.instantiate<nav_msgs::Odometry>())
    sinks.odometry(message.getTopic(), from_message(*odometry));
  else if (const auto text = message.instantiate<std_msgs::String>(); text && sinks.text)
    sinks.text(message.getTopic(), text->data);
  else if (const auto packets = message.instantiate<VelodyneScan>(); packets && sinks.packets)
    sinks.packets(message.getTopic(), from_message(*packets));
  return true;
}

struct Output::State {
  rosbag::Bag bag;
  int descriptor = -1;  ///< of its file; the bag's own
};

namespace {

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
