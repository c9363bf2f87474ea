#include "sensors/rosbag/reader.hpp"

#include <algorithm>
#include <cmath>

#include "core/result.hpp"
#include "sensors/rosbag/cloud_fields.hpp"

namespace madori::sensors {
namespace {

constexpr std::size_t kMaxBeams = 20'000;

namespace bridge = rosbag_bridge;

Stamp to_stamp(std::int64_t stamp_ns) {
  return Stamp(Duration(stamp_ns));
}

/// The topic of this kind to read; empty where there is none.
std::string choose(const std::vector<bridge::Topic>& topics, bridge::Kind kind, const std::string& wanted,
                   const std::string& usual, const std::string& option, const std::string& file) {
  std::vector<std::string> names;
  for (const bridge::Topic& topic : topics)
    if (topic.kind == kind) names.push_back(topic.name);
  const auto has = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::string all;
  for (const auto& name : names) all += (all.empty() ? "" : ", ") + name;
  if (!wanted.empty() && !has(wanted)) throw Error(file, "has no topic " + wanted, "choose one of: " + all);
  if (!wanted.empty()) return wanted;
  if (names.size() <= 1) return all;
  if (has(usual)) return usual;
  throw Error(file, "has several topics of one kind: " + all, "name the one to use with " + option);
}

std::optional<OdometryReading> convert(const bridge::Pose& pose) {
  const double ww = pose.qw * pose.qw, xx = pose.qx * pose.qx, yy = pose.qy * pose.qy, zz = pose.qz * pose.qz;
  const double yaw_rad =
      std::atan2(2.0 * (pose.qw * pose.qz + pose.qx * pose.qy), ww + xx - yy - zz);  // of any length
  OdometryReading reading{to_stamp(pose.stamp_ns), {pose.x, pose.y, yaw_rad}};
  if (!(ww + xx + yy + zz > 0.0) || !reading.odom_from_base.is_finite()) return std::nullopt;
  return reading;
}

std::optional<ScanRecord> convert(const std::string& topic, const bridge::Scan& in,
                                  const MountedLidar& lidar) {
  const bool sound = std::isfinite(in.angle_min) && std::isfinite(in.angle_increment) &&
                     in.angle_increment != 0.0F && in.range_max > 0.0F && in.ranges.size() <= kMaxBeams;
  if (!sound) return std::nullopt;
  ScanRecord record{topic, {}, lidar.base_from_lidar, {}, {}};
  LaserScan& scan = record.scan;
  scan.lidar = lidar.place;
  scan.stamp = to_stamp(in.stamp_ns);
  if (in.time_increment > 0.0F && in.time_increment < 1.0F)
    scan.beam_period = duration_from_seconds(in.time_increment);
  scan.angle_min_rad = in.angle_min;
  scan.angle_step_rad = in.angle_increment;
  scan.range_max_m = in.range_max;
  scan.ranges_m.reserve(in.ranges.size());
  for (const float range_m : in.ranges) {
    const bool hit = range_m > 0.0F && range_m >= in.range_min && range_m < in.range_max;
    scan.ranges_m.push_back(hit ? range_m : LaserScan::kNoReturn);
  }
  if (in.intensities.size() == in.ranges.size()) scan.intensities = in.intensities;
  return record;
}

}  // namespace

BagReader::BagReader(const std::filesystem::path& file, BagOptions options)
    : file_(file), options_(std::move(options)) {
  std::vector<bridge::Topic> topics;
  try {
    input_ = std::make_unique<bridge::Input>(file.string());
    topics = input_->topics();
  } catch (const std::exception& e) {
    throw Error(file.string(), std::string("is no readable ROS 1 bag: ") + e.what(),
                "an interrupted recording is mended by `rosbag reindex`");
  }
  std::vector<std::string> chosen{
      choose(topics, bridge::Kind::Scan, options_.scan_topic, "/scan", "--scan-topic", file.string()),
      choose(topics, bridge::Kind::Cloud, options_.cloud_topic, "/velodyne_points", "--cloud-topic",
             file.string()),
      choose(topics, bridge::Kind::Odometry, options_.odometry_topic, "/odom", "--odometry-topic",
             file.string())};
  std::erase(chosen, "");
  if (chosen.empty())
    throw Error(file.string(), "holds no LaserScan, PointCloud2 or Odometry",
                "record the lidar and the odometry");
  input_->choose(chosen);
}

BagReader::~BagReader() = default;

const MountedLidar& BagReader::lidar_of(bool planar, const std::string& topic, const std::string& frame) {
  const auto [found, fresh] = found_.try_emplace({topic, frame});
  if (!fresh || options_.lidars.empty()) return found->second;
  const MountedLidar* const lidar = which_lidar(options_.lidars, planar, topic, frame);
  if (lidar == nullptr)
    throw Error(file_.string() + ": " + topic,
                "may be of each of the site's lidars: " + names_of(options_.lidars),
                "name the one with --lidar");
  return found->second = *lidar;
}

std::optional<LogRecord> BagReader::next() {
  const auto refuse = [this](const std::string& topic, std::int64_t stamp_ns, const std::string& why) {
    throw Error(file_.string() + ": " + topic + " at " + std::to_string(static_cast<double>(stamp_ns) * 1e-9),
                why, "cut the damaged part out with `rosbag filter`");
  };
  bridge::Input::Sinks sinks;
  sinks.scan = [&](const std::string& topic, const bridge::Scan& in) {
    auto record = convert(topic, in, lidar_of(true, topic, in.frame));
    if (!record) refuse(topic, in.stamp_ns, "the scan's angles or limits are no numbers");
    ready_.emplace_back(std::move(*record));
  };
  sinks.cloud = [&](const std::string& topic, const bridge::Cloud& in) {
    auto cloud = cloud_from_fields(in);
    if (!cloud) refuse(topic, in.stamp_ns, cloud.reason());
    const MountedLidar& lidar = lidar_of(false, topic, in.frame);
    CloudRecord record{topic, std::move(cloud).value(), lidar.base_from_lidar, lidar.height_m};
    record.cloud.lidar = lidar.place;
    ready_.emplace_back(std::move(record));
  };
  sinks.odometry = [&](const std::string& topic, const bridge::Pose& in) {
    const auto reading = convert(in);
    if (!reading) refuse(topic, in.stamp_ns, "the pose is no number, or has no orientation");
    ready_.emplace_back(*reading);
  };
  while (ready_.empty()) {
    try {
      if (!input_->next(sinks)) return std::nullopt;
    } catch (const Error&) {
      throw;
    } catch (const std::exception& e) {
      throw Error(file_.string(), std::string("is damaged: ") + e.what(), "mend it with `rosbag reindex`");
    }
  }
  LogRecord record = std::move(ready_.front());
  ready_.pop_front();
  return record;
}

}  // namespace madori::sensors
