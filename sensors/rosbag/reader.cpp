#include "sensors/rosbag/reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/result.hpp"
#include "sensors/rosbag/cloud_fields.hpp"

namespace madori::sensors {
namespace {

constexpr std::size_t kMaxBeams = 20'000;

namespace bridge = rosbag_bridge;

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

/// Where a topic's stamps lie before the times of recording, and how far the middle half of them spreads.
struct ClockOfTopic {
  Duration before{}, spread{};

  explicit ClockOfTopic(std::vector<std::int64_t> all_ns) {
    std::ranges::sort(all_ns);
    const std::size_t n = all_ns.size();
    before = Duration(all_ns[n / 2]);
    spread = Duration(all_ns[n - 1 - n / 4] - all_ns[n / 4]);
  }
};

std::optional<OdometryReading> convert(Stamp stamp, const bridge::Pose& pose) {
  const double ww = pose.qw * pose.qw, xx = pose.qx * pose.qx, yy = pose.qy * pose.qy, zz = pose.qz * pose.qz;
  const double yaw_rad =
      std::atan2(2.0 * (pose.qw * pose.qz + pose.qx * pose.qy), ww + xx - yy - zz);  // of any length
  OdometryReading reading{stamp, {pose.x, pose.y, yaw_rad}};
  if (!(ww + xx + yy + zz > 0.0) || !reading.odom_from_base.is_finite()) return std::nullopt;
  return reading;
}

/// A range_max of 0 or NaN and a range_min of NaN state none.
std::optional<ScanRecord> convert(const std::string& topic, Stamp stamp, const bridge::Scan& in,
                                  const MountedLidar& lidar) {
  const bool sound = std::isfinite(in.angle_min) && std::isfinite(in.angle_increment) &&
                     in.angle_increment != 0.0F && !(in.range_max < 0.0F) && in.ranges.size() <= kMaxBeams;
  if (!sound) return std::nullopt;
  ScanRecord record{topic, {}, lidar.base_from_lidar, {}, {}};
  LaserScan& scan = record.scan;
  scan.lidar = lidar.place;
  scan.stamp = stamp;
  if (in.time_increment > 0.0F && in.time_increment < 1.0F)
    scan.beam_period = duration_from_seconds(in.time_increment);
  scan.angle_min_rad = in.angle_min;
  scan.angle_step_rad = in.angle_increment;
  const float range_max = in.range_max > 0.0F ? in.range_max : std::numeric_limits<float>::infinity();
  scan.range_max_m = range_max;
  scan.ranges_m.reserve(in.ranges.size());
  for (const float range_m : in.ranges) {
    const bool hit = range_m > 0.0F && !(range_m < in.range_min) && range_m < range_max;
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
  if (chosen.empty()) {
    std::string others;
    for (const std::string& type : input_->other_types()) others += (others.empty() ? ", but " : ", ") + type;
    throw Error(file.string(), "holds no LaserScan, PointCloud2 or Odometry" + others,
                "record the lidar and the odometry");
  }
  input_->choose(chosen);
  put_on_one_clock(chosen);
}

BagReader::~BagReader() = default;

/// What is measured is recorded soon: topics whose stamps lie elsewhere before the times of recording were
/// stamped by other clocks.
void BagReader::put_on_one_clock(const std::vector<std::string>& topics) {
  constexpr std::size_t kMessages = 25;
  std::map<std::string, std::vector<std::int64_t>> before;
  try {
    before = input_->stamps_before_recording(kMessages);
  } catch (const std::exception&) {
    return;  // next() reports the damage when it comes to it
  }
  const std::string& first = topics.back();  // the odometry, where there is one
  if (before[first].empty()) return;
  const ClockOfTopic right(before[first]);
  for (const std::string& topic : topics) {
    if (topic == first || before[topic].empty()) continue;
    const ClockOfTopic other(before[topic]);
    const Duration by = right.before - other.before;
    if (std::chrono::abs(by) <= kBagDisorder) continue;
    const std::string clocks = topic + " and " + first + " are stamped by two clocks, " +
                               std::to_string(to_seconds(std::chrono::abs(by))) + " s apart";
    if (std::max(right.spread, other.spread) > kBagDisorder)
      throw Error(file_.string(), clocks + " and more or less", "record with clocks that are kept together");
    moved_[topic] = by;
    if (options_.remark) options_.remark(clocks + ": all times are those of " + first);
  }
}

Stamp BagReader::stamp_of_topic(const std::string& topic, std::int64_t stamp_ns) const {
  const auto moved = moved_.find(topic);
  return Stamp(Duration(stamp_ns) + (moved == moved_.end() ? Duration(0) : moved->second));
}

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
    auto record = convert(topic, stamp_of_topic(topic, in.stamp_ns), in, lidar_of(true, topic, in.frame));
    if (!record) refuse(topic, in.stamp_ns, "the scan's angles or limits are no numbers");
    ready_.emplace_back(std::move(*record));
  };
  sinks.cloud = [&](const std::string& topic, const bridge::Cloud& in) {
    auto cloud = cloud_from_fields(in);
    if (!cloud) refuse(topic, in.stamp_ns, cloud.reason());
    const MountedLidar& lidar = lidar_of(false, topic, in.frame);
    CloudRecord record{topic, std::move(cloud).value(), lidar.base_from_lidar, lidar.height_m};
    record.cloud.lidar = lidar.place;
    if (const auto moved = moved_.find(topic); moved != moved_.end()) record.cloud.stamp += moved->second;
    ready_.emplace_back(std::move(record));
  };
  sinks.odometry = [&](const std::string& topic, const bridge::Pose& in) {
    const auto reading = convert(stamp_of_topic(topic, in.stamp_ns), in);
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
