#include "sensors/rosbag/messages.hpp"

#include <algorithm>
#include <iterator>

namespace madori::sensors::rosbag_bridge {
namespace {

constexpr std::size_t kPacketBytes = 1206;
constexpr std::size_t kCovariance = 36;

std::int64_t take_stamp_ns(BagBytes& in) {
  const std::int64_t seconds = in.number<std::uint32_t>();
  return seconds * 1'000'000'000 + in.number<std::uint32_t>();
}

/// std_msgs/Header: number, stamp, frame.
std::int64_t take_header(BagBytes& in, std::string& frame) {
  (void)in.number<std::uint32_t>();
  const std::int64_t stamp_ns = take_stamp_ns(in);
  frame = in.text();
  return stamp_ns;
}

/// What LaserScan and MultiEchoLaserScan have before their ranges.
Scan take_sweep(BagBytes& in) {
  Scan scan;
  scan.stamp_ns = take_header(in, scan.frame);
  scan.angle_min = in.number<float>();
  (void)in.number<float>();  // angle_max
  scan.angle_increment = in.number<float>();
  scan.time_increment = in.number<float>();
  (void)in.number<float>();  // scan_time
  scan.range_min = in.number<float>();
  scan.range_max = in.number<float>();
  return scan;
}

Field take_field(BagBytes& in) {
  Field field;
  field.name = in.text();
  field.offset = in.number<std::uint32_t>();
  field.type = in.number<std::uint8_t>();
  field.count = in.number<std::uint32_t>();
  return field;
}

}  // namespace

std::optional<Kind> kind_of(const std::string& type, const std::string& md5sum) {
  const auto* const found = std::ranges::find_if(
      kMessageTypes, [&](const MessageType& known) { return type == known.name && md5sum == known.md5sum; });
  return found == std::end(kMessageTypes) ? std::nullopt : std::optional(found->kind);
}

Scan scan_from(Bytes message) {
  BagBytes in(message);
  Scan scan = take_sweep(in);
  scan.ranges = in.numbers<float>();
  scan.intensities = in.numbers<float>();
  return scan;
}

Scan first_echoes_from(Bytes message) {
  BagBytes in(message);
  Scan scan = take_sweep(in);
  for (auto beams = in.number<std::uint32_t>(); beams > 0; --beams) {
    const std::vector<float> echoes = in.numbers<float>();
    scan.ranges.push_back(echoes.empty() ? 0.0F : echoes.front());
  }
  return scan;
}

std::int64_t header_stamp_ns(Bytes message) {
  BagBytes in(message);
  (void)in.number<std::uint32_t>();
  return take_stamp_ns(in);
}

Cloud cloud_from(Bytes message) {
  BagBytes in(message);
  Cloud cloud;
  cloud.stamp_ns = take_header(in, cloud.frame);
  cloud.height = in.number<std::uint32_t>();
  cloud.width = in.number<std::uint32_t>();
  for (auto fields = in.number<std::uint32_t>(); fields > 0; --fields) cloud.fields.push_back(take_field(in));
  cloud.big_endian = in.number<std::uint8_t>() != 0;
  cloud.point_step = in.number<std::uint32_t>();
  cloud.row_step = in.number<std::uint32_t>();
  cloud.data = in.numbers<std::uint8_t>();
  (void)in.number<std::uint8_t>();  // is_dense
  return cloud;
}

Pose odometry_from(Bytes message) {
  BagBytes in(message);
  Pose pose;
  std::string frame;
  pose.stamp_ns = take_header(in, frame);
  (void)in.text();  // child_frame_id
  for (double* value : {&pose.x, &pose.y, &pose.z, &pose.qx, &pose.qy, &pose.qz, &pose.qw})
    *value = in.number<double>();
  (void)in.take((kCovariance + 6 + kCovariance) * sizeof(double));  // twist, and both covariances
  return pose;
}

std::string text_from(Bytes message) {
  return BagBytes(message).text();
}

std::vector<Packet> packets_from(Bytes message) {
  BagBytes in(message);
  std::string frame;
  (void)take_header(in, frame);
  std::vector<Packet> packets;
  for (auto count = in.number<std::uint32_t>(); count > 0; --count) {
    const std::int64_t received_ns = take_stamp_ns(in);
    const Bytes bytes = in.take(kPacketBytes);
    packets.push_back({received_ns, {bytes.begin(), bytes.end()}});
  }
  return packets;
}

}  // namespace madori::sensors::rosbag_bridge
