#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <tuple>

#include "sensors/rosbag/bridge.hpp"
#include "sensors/rosbag/bridge_time.hpp"
#include "sensors/rosbag/velodyne_scan.hpp"

namespace madori::sensors::rosbag_bridge {
namespace {

template <class Message>
bool is(const std::string& type) {
  return type == ros::message_traits::datatype<Message>();
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

}  // namespace madori::sensors::rosbag_bridge
