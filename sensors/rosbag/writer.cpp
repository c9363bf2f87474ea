#include "sensors/rosbag/writer.hpp"

#include <cmath>

#include "core/result.hpp"
#include "sensors/rosbag/bridge.hpp"
#include "sensors/rosbag/cloud_fields.hpp"

namespace madori::sensors {
namespace {

rosbag_bridge::Pose planar_pose(Stamp stamp, double x_m, double y_m, double yaw_rad) {
  rosbag_bridge::Pose pose;
  pose.stamp_ns = stamp.time_since_epoch().count();
  pose.x = x_m;
  pose.y = y_m;
  pose.qz = std::sin(yaw_rad / 2.0);
  pose.qw = std::cos(yaw_rad / 2.0);
  return pose;
}

/// Of (x, y, yaw) spread over (x, y, z, roll, pitch, yaw), row by row.
std::vector<double> spread(const Eigen::Matrix3d& covariance) {
  constexpr std::array<std::size_t, 3> kPlace{0, 1, 5};
  std::vector<double> all(36, 0.0);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      all[kPlace[row] * 6 + kPlace[column]] =
          covariance(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
  return all;
}

}  // namespace

template <class Action>
void BagWriter::guarded(Action action) {
  try {
    action();
  } catch (const std::exception& e) {
    throw Error(file_.string(), std::string("cannot be written: ") + e.what(),
                "check the folder and the disk space");
  }
}

BagWriter::BagWriter(const std::filesystem::path& file) : file_(file) {
  guarded([&] { output_ = std::make_unique<rosbag_bridge::Output>(file.string()); });
}

BagWriter::~BagWriter() = default;

void BagWriter::write(const std::string& topic, const LaserScan& scan) {
  write(topic, scan, scan.stamp);
}

void BagWriter::write(const std::string& topic, const VelocityCommand& command, Stamp stamp) {
  guarded([&] {
    output_->write_twist(topic, stamp.time_since_epoch().count(), command.linear_mps, command.angular_radps);
  });
}

void BagWriter::write(const std::string& topic, const LaserScan& scan, Stamp recorded) {
  rosbag_bridge::Scan out;
  out.stamp_ns = scan.stamp.time_since_epoch().count();
  out.frame = frame_of(scan.lidar);
  out.angle_min = static_cast<float>(scan.angle_min_rad);
  out.angle_increment = static_cast<float>(scan.angle_step_rad);
  out.time_increment = static_cast<float>(to_seconds(scan.beam_period));
  out.range_max = static_cast<float>(scan.range_max_m);
  out.ranges = scan.ranges_m;
  out.intensities = scan.intensities;
  guarded([&] { output_->write(topic, recorded.time_since_epoch().count(), out); });
}

void BagWriter::write(const std::string& topic, const PointCloud<Lidar>& cloud) {
  rosbag_bridge::Cloud fields = fields_from_cloud(cloud);
  fields.frame = frame_of(cloud.lidar);
  guarded([&] { output_->write(topic, fields); });
}

void BagWriter::write(const std::string& topic, const std::vector<RawPacket>& packets, std::size_t lidar,
                      Stamp stamp) {
  std::vector<rosbag_bridge::Packet> out;
  out.reserve(packets.size());
  for (const RawPacket& packet : packets)
    out.push_back({packet.received.time_since_epoch().count(), packet.bytes});
  guarded([&] { output_->write(topic, stamp.time_since_epoch().count(), frame_of(lidar), out); });
}

void BagWriter::write(const std::string& topic, const OdometryReading& reading) {
  const auto& pose = reading.odom_from_base;
  guarded([&] {
    output_->write_odometry(topic, planar_pose(reading.stamp, pose.x_m(), pose.y_m(), pose.yaw_rad()));
  });
}

void BagWriter::write(const std::string& topic, const PoseEstimate& estimate) {
  const auto& pose = estimate.map_from_base;
  rosbag_bridge::Pose out = planar_pose(estimate.stamp, pose.x_m(), pose.y_m(), pose.yaw_rad());
  out.covariance = spread(estimate.covariance);
  guarded([&] { output_->write_estimate(topic, out); });
}

void BagWriter::write(const std::string& topic, const Path& path, Stamp stamp) {
  std::vector<rosbag_bridge::Pose> poses;
  poses.reserve(path.points.size());
  for (const PathPoint& point : path.points)
    poses.push_back(planar_pose(stamp, point.position.x_m, point.position.y_m, point.heading_rad));
  guarded([&] { output_->write_path(topic, stamp.time_since_epoch().count(), poses); });
}

void BagWriter::write(const std::string& topic, const std::string& text, Stamp stamp) {
  guarded([&] { output_->write_text(topic, stamp.time_since_epoch().count(), text); });
}

void BagWriter::write_vehicle_frames(const std::string& topic, const PoseEstimate& pose,
                                     const OdometryReading& odometry) {
  const auto& odom_from_base = odometry.odom_from_base;
  const auto in_odom =
      planar_pose(odometry.stamp, odom_from_base.x_m(), odom_from_base.y_m(), odom_from_base.yaw_rad());
  std::vector<rosbag_bridge::FrameIn> frames{{"odom", "base_link", in_odom}};
  if (pose.stamp != Stamp{}) {
    const Transform2<Map, Odom> map_from_odom = pose.map_from_base * odom_from_base.inverse();
    const auto in_map =
        planar_pose(odometry.stamp, map_from_odom.x_m(), map_from_odom.y_m(), map_from_odom.yaw_rad());
    frames.push_back({"map", "odom", in_map});
  }
  guarded([&] { output_->write_frames(topic, odometry.stamp.time_since_epoch().count(), frames, false); });
}

void BagWriter::write_mounted_frames(const std::string& topic, const std::vector<MountedFrame>& mounted,
                                     Stamp stamp) {
  std::vector<rosbag_bridge::FrameIn> frames;
  for (const MountedFrame& m : mounted) {
    frames.push_back({m.parent, m.child, planar_pose(stamp, m.x_m, m.y_m, m.yaw_rad)});
    frames.back().pose.z = m.z_m;
  }
  guarded([&] { output_->write_frames(topic, stamp.time_since_epoch().count(), frames, true); });
}

std::string BagWriter::frame_of(std::size_t lidar) const {
  return lidar < lidar_frames_.size() ? lidar_frames_[lidar] : "lidar";
}

void BagWriter::close() {
  guarded([&] { output_->close(); });
}

}  // namespace madori::sensors
