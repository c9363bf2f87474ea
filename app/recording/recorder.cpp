#include "app/recording/recorder.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <map>
#include <utility>

#include "app/recording/input_text.hpp"
#include "app/recording/state_bytes.hpp"
#include "core/failure_words.hpp"
#include "core/thread_role.hpp"
#include "sensors/rosbag/writer.hpp"

namespace madori::app {

namespace fs = std::filesystem;

namespace {

constexpr double kThinEvery_s = 0.5;
constexpr std::size_t kRevolutionPackets = 120;  ///< 76 at 10 Hz

/// Every fourth firing.
PointCloud<Lidar> thinned(const PointCloud<Lidar>& cloud) {
  constexpr std::size_t kRings = 16;
  PointCloud<Lidar> thin{cloud.stamp, {}};
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (i / kRings % 4 == 0) thin.points.push_back(cloud.points[i]);
  return thin;
}

/// The input without its revolutions, which take much memory.
CycleInput without_clouds(const CycleInput& in) {
  CycleInput input;
  input.now = in.now;
  input.drive = in.drive;
  input.packets = in.packets;
  input.scans = in.scans;
  if (!has_packets(in)) input.clouds = in.clouds;
  return input;
}

std::size_t spinning_before(const std::vector<LidarModel>& lidars, std::size_t lidar) {
  const auto until = lidars.begin() + static_cast<std::ptrdiff_t>(std::min(lidar, lidars.size()));
  return static_cast<std::size_t>(std::count_if(
      lidars.begin(), until, [](const LidarModel& model) { return model.kind == LidarKind::Spinning; }));
}

std::string numbered(const char* topic, std::size_t number) {
  return number == 0 ? topic : fmt::format("{}/{}", topic, number);
}

}  // namespace

std::string lidar_frame(const LidarModel& lidar) {
  std::string frame = lidar.name;
  for (char& c : frame)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return frame.empty() ? "lidar" : frame;
}

std::string scan_topic(std::size_t lidar) {
  return numbered(kScanTopic, lidar);
}

std::string packet_topic(const char* topic, const std::vector<LidarModel>& lidars, std::size_t lidar) {
  return numbered(topic, spinning_before(lidars, lidar));
}

Recorder::Recorder(fs::path folder, const RecorderOptions& options)
    : folder_(std::move(folder)),
      options_(options),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Recorder::~Recorder() = default;

void Recorder::add(const CycleInput& input, const CycleOutput& output, const CycleState& state) {
  Record record{without_clouds(input),
                input_text(input, state.pose),
                std::nullopt,
                "",
                output,
                state.pose,
                state.odometry.reading(),
                std::nullopt,
                false};
  if (has_packets(input) && to_seconds(input.now - thinned_) >= kThinEvery_s) {
    thinned_ = input.now;
    record.thinned = thinned(input.clouds.back());
  }
  const auto& points = state.way.plain.points;
  if (points.size() != path_size_ || state.detour.id != path_of_) {
    path_size_ = points.size();
    path_of_ = state.detour.id;
    record.path = state.way.plain;
  }
  if (segment_begun_ == Stamp{}) segment_begun_ = input.now;
  if (to_seconds(input.now - segment_begun_) >= options_.segment_s) {
    segment_begun_ = input.now;
    record.state = state_bytes(state);
  }
  const bool drives_now = drives(state.mode);
  record.stop = drove_ && !drives_now && !state.errand.arrived && state.mode != Mode::Idle;
  drove_ = drives_now;
  {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() >= options_.max_waiting)
      ++lost_;
    else
      waiting_.push_back(std::move(record));
  }
  wake_.notify_one();
}

std::uint64_t Recorder::lost() const {
  const std::scoped_lock lock(mutex_);
  return lost_;
}

std::string Recorder::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

fs::path Recorder::bag_name(int number) const {
  return folder_ / fmt::format("{:03}.bag", number);
}

/// Each bag tells where the lidars are mounted: it is opened alone.
void Recorder::begin_segment(Stamp at) {
  fs::create_directories(folder_);
  bag_ = std::make_unique<sensors::BagWriter>(bag_name(number_));
  std::vector<std::string> frames;
  std::vector<sensors::MountedFrame> mounted;
  for (const LidarModel& lidar : options_.lidars) {
    const auto& m = lidar.mounting;
    frames.push_back(lidar_frame(lidar));
    mounted.push_back({"base_link", frames.back(), m.x_m, m.y_m, m.z_m, m.yaw_rad});
  }
  bag_->set_lidar_frames(frames);
  if (!mounted.empty()) bag_->write_mounted_frames(kMountedTopic, mounted, at);
}

void Recorder::remember(const std::vector<sensors::RawPacket>& packets) {
  newest_.insert(newest_.end(), packets.begin(), packets.end());
  const std::size_t spinning = spinning_before(options_.lidars, options_.lidars.size());
  while (newest_.size() > kRevolutionPackets * std::max<std::size_t>(1, spinning)) newest_.pop_front();
}

/// Where older bags cannot be linked or removed the recording goes on all the same.
void Recorder::end_segment() {
  bag_->close();
  bag_.reset();
  try {
    tidy(number_++);
  } catch (const std::exception& e) {
    tell(failure_words(e));
  }
}

void Recorder::tidy(int ended) {
  if (std::exchange(keep_, false)) {
    keep(bag_name(ended));
    if (ended > 0) keep(bag_name(ended - 1));
  }
  make_room(folder_, options_.room);
}

void Recorder::tell(const std::string& problem) {
  if (problem == problem_) return;  // nobody else writes it
  spdlog::warn("recording: {}", problem);
  const std::scoped_lock lock(mutex_);
  problem_ = problem;
}

void Recorder::keep(const fs::path& bag) const {
  const fs::path kept = folder_ / "stops" / bag.filename();
  fs::create_directories(kept.parent_path());
  if (fs::exists(bag) && !fs::exists(kept)) fs::create_hard_link(bag, kept);
}

void Recorder::write_packets(const char* topic, const std::vector<sensors::RawPacket>& packets, Stamp at) {
  std::map<std::size_t, std::vector<sensors::RawPacket>> by_lidar;
  for (const sensors::RawPacket& packet : packets) by_lidar[packet.lidar].push_back(packet);
  for (const auto& [lidar, some] : by_lidar)
    bag_->write(packet_topic(topic, options_.lidars, lidar), some, lidar, at);
}

void Recorder::write_step(const Record& record) {
  const Stamp now = record.input.now;
  write_packets(kPacketTopic, record.input.packets, now);
  if (record.thinned) bag_->write(kThinTopic, *record.thinned);
  for (const auto& cloud : record.input.clouds) bag_->write(kCloudTopic, cloud);
  for (const auto& scan : record.input.scans) bag_->write(scan_topic(scan.lidar), scan, now);
  if (!record.input.drive.empty()) {
    bag_->write("/odom", record.odometry);
    bag_->write_vehicle_frames(kFramesTopic, record.pose, record.odometry);
  }
  if (record.pose.stamp != Stamp{}) bag_->write("/pose", record.pose);  // before that there is none
  if (record.path) bag_->write("/path", *record.path, now);
  bag_->write(kInputTopic, record.text, now);
  bag_->write(kCommandTopic, command_text(record.output, now), now);
  bag_->write(kTwistTopic, record.output.command, now);
  for (const std::string& event : record.output.events) bag_->write(kEventTopic, event, now);
  keep_ = keep_ || record.stop;
}

/// Whether the step is in a bag. After a failure the next bag begins where the cycle's state is at hand.
bool Recorder::write(const Record& record) {
  if (!bag_ && number_ == 0) begin_segment(record.input.now);
  const bool kept = bag_ != nullptr;
  remember(record.input.packets);
  if (kept) write_step(record);
  if (record.state.empty()) return kept;
  if (kept) end_segment();
  const Stamp after = record.input.now + Duration(1);  // before everything of the next step
  begin_segment(after);
  bag_->write(kStateTopic, record.state, after);
  write_packets(kEarlierTopic, {newest_.begin(), newest_.end()}, after);
  return kept;
}

/// The disk did not take it: the bag ends where it is, without its index. It gets the ending that ROS tools
/// know for such a one (rosbag reindex).
void Recorder::give_up_segment() {
  bag_.reset();
  std::error_code ignored;
  fs::rename(bag_name(number_), fs::path(bag_name(number_)) += ".active", ignored);
  ++number_;
}

void Recorder::run(const std::stop_token& stop) {
  (void)take_role("recorder", ThreadRole::Ordinary);
  std::unique_lock lock(mutex_);
  while (wake_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
    const auto batch = std::exchange(waiting_, {});
    lock.unlock();
    std::uint64_t failed = 0;
    for (const Record& record : batch) {
      try {
        if (!write(record)) ++failed;
      } catch (const std::exception& e) {
        tell(failure_words(e));
        ++failed;
        give_up_segment();
      }
    }
    lock.lock();
    lost_ += failed;
  }
  lock.unlock();
  try {
    if (bag_) end_segment();
  } catch (const std::exception& e) {
    tell(failure_words(e));
  }
  bag_.reset();
}

}  // namespace madori::app
