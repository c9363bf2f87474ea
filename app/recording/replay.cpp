#include "app/recording/replay.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "app/recording/bag_room.hpp"
#include "app/recording/input_text.hpp"
#include "app/recording/recorder.hpp"
#include "app/recording/state_bytes.hpp"
#include "core/result.hpp"
#include "sensors/lidar/registry.hpp"
#include "sensors/rosbag/bridge.hpp"
#include "sensors/rosbag/cloud_fields.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;
namespace bridge = sensors::rosbag_bridge;

std::vector<fs::path> bags_of(const fs::path& run) {
  if (fs::is_regular_file(run)) return {run};
  std::vector<fs::path> bags;
  if (fs::is_directory(run))
    for (const auto& entry : fs::directory_iterator(run))
      if (entry.path().extension() == ".bag") bags.push_back(entry.path());
  std::ranges::sort(bags, {}, [](const fs::path& bag) { return std::pair(bag_number(bag), bag); });
  if (bags.empty()) throw Error(run.string(), "holds no bag", "name a folder below SITE/runs");
  return bags;
}

std::vector<std::string> replayed_topics(const CycleConfig& config) {
  std::vector<std::string> topics{kCloudTopic, kStateTopic, kInputTopic, kCommandTopic};
  for (std::size_t i = 0; i < config.lidars.size(); ++i) {
    topics.push_back(scan_topic(i));
    for (const char* topic : {kPacketTopic, kEarlierTopic})
      topics.push_back(packet_topic(topic, config.lidars, i));
  }
  return topics;
}

/// Gives the poses of a recording back.
class RecordedPose final : public PoseSource {
 public:
  explicit RecordedPose(const PoseEstimate& pose) : pose_(pose) {}
  PoseEstimate on_odometry(const OdometryReading& /*reading*/) override { return pose_; }
  void on_cloud(const PointCloud<Base>& /*cloud*/, const Transform2<Odom, Base>& /*odom*/) override {}
  void set_pose(const Transform2<Map, Base>& /*pose*/, const PoseSigma& /*sigma*/) override {}
  void search_anew() override {}
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return {}; }

 private:
  const PoseEstimate& pose_;
};

/// Feeds recorded steps to the cycle and compares its commands.
class Player {
 public:
  Player(const CycleConfig& config, std::unique_ptr<PoseSource> source)
      : config_(config), state_(config, std::move(source)) {}

  /// Hands the inputs to `look` instead of running the cycle on them.
  Player(const CycleConfig& config, InputLook look) : Player(config, std::make_unique<RecordedPose>(pose_)) {
    look_ = std::move(look);
  }

  /// The bag that follows does not go on where the one before ended.
  void begin_anew() {
    finish();
    state_ = CycleState(config_, std::make_unique<RecordedPose>(pose_));
    clouds_.clear();
    scans_.clear();
    assemblies_ = assemblies();
    result_.recorded_poses = awaits_state_ = true;
  }
  void take_state(const std::string& bytes) {
    if (!awaits_state_) return;
    restore_state(state_, bytes, config_);
    awaits_state_ = false;
  }
  void take_scan(const std::string& topic, const bridge::Scan& scan) {
    for (std::size_t i = 0; i < config_.lidars.size(); ++i)
      if (topic == scan_topic(i)) scans_[i].push_back(scan.ranges);
  }
  /// Those of the bag before tell of the revolution that was under way when the first bag began.
  void take_packets(const std::string& topic, const std::vector<bridge::Packet>& packets) {
    for (auto& [lidar, assembly] : assemblies_) {
      const bool earlier = topic == packet_topic(kEarlierTopic, config_.lidars, lidar);
      if (!earlier && topic != packet_topic(kPacketTopic, config_.lidars, lidar)) continue;
      if (earlier && assembly.begun) return;
      for (const auto& packet : packets)
        assembly.decoder->push(packet.bytes, Stamp(Duration(packet.received_ns)));
      assembly.begun = assembly.begun || !packets.empty();
    }
  }
  void take_cloud(const bridge::Cloud& message) {
    auto cloud = sensors::cloud_from_fields(message);
    if (!cloud)
      throw Error("recording", "holds a damaged revolution: " + cloud.reason(), "use another recording");
    clouds_.push_back(std::move(cloud).value());
  }
  /// A step is run when the next one begins: messages of the same moment may stand in any order.
  void take_input(const std::string& text) {
    finish();
    if (awaits_state_ && !look_)
      throw Error("recording", "does not say what the cycle remembered at its beginning",
                  "replay the whole run");
    input_ = text;
    if (result_.recorded_poses) pose_ = pose_from_text(text);
  }
  void take_command(const std::string& text) { recorded_[stamp_of_command(text)] = text; }
  void finish() {
    if (input_.empty()) return;
    const CycleInput input = next_input();
    if (look_) {
      ++result_.steps;
      input_.clear();
      return look_(input);
    }
    if (result_.recorded_poses) state_.pose = pose_;
    if (result_.steps++ == 0) begun_ = input.now;
    result_.recorded_s = to_seconds(input.now - begun_);
    const auto before = std::chrono::steady_clock::now();
    StepResult done = step(std::move(state_), input, config_);
    result_.worked_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    state_ = std::move(done.state);
    const auto recorded = recorded_.extract(input.now);
    const bool same = !recorded.empty() && recorded.mapped() == command_text(done.output, input.now);
    if (!same && result_.different++ == 0)
      result_.first_different = static_cast<std::int64_t>(result_.steps) - 1;
    input_.clear();
  }
  [[nodiscard]] const ReplayResult& result() const { return result_; }

 private:
  /// Of a lidar whose packets are recorded as they came.
  struct Assembly {
    std::unique_ptr<sensors::LidarDecoder> decoder;
    std::deque<sensors::LidarSweep> revolutions;
    bool begun = false;
  };
  std::map<std::size_t, Assembly> assemblies() {
    std::map<std::size_t, Assembly> made;
    for (std::size_t i = 0; i < config_.lidars.size(); ++i) {
      const auto* row = sensors::find_lidar(config_.lidars[i].type);
      if (row == nullptr || !row->keeps_bytes) continue;
      sensors::LidarSettings settings;
      settings.name = config_.lidars[i].name;
      settings.mounting = config_.lidars[i].mounting;
      made[i].decoder = row->decoder(settings, [this, i](sensors::LidarSweep& sweep) {
        assemblies_[i].revolutions.push_back(std::move(sweep));
      });
    }
    return made;
  }
  CycleInput next_input() {
    CycleInput input = input_from_text(input_);
    for (const RecordedCloud& recorded : clouds_of_text(input_)) {
      input.clouds.push_back(recorded.firing_us ? assembled(recorded.lidar, *recorded.firing_us) : cloud());
      input.clouds.back().stamp = recorded.stamp;
      input.clouds.back().lidar = recorded.lidar;
    }
    for (LaserScan& scan : scans_of_text(input_)) {
      auto& waiting = scans_[scan.lidar];
      if (waiting.empty()) throw Error("recording", "misses a scan", "use another recording");
      scan.ranges_m = std::move(waiting.front());
      waiting.pop_front();
      input.scans.push_back(std::move(scan));
    }
    return input;
  }
  PointCloud<Lidar> cloud() {
    if (clouds_.empty()) throw Error("recording", "misses a revolution", "use another recording");
    PointCloud<Lidar> next = std::move(clouds_.front());
    clouds_.pop_front();
    return next;
  }
  /// The revolution that began at this time of the lidar; those before it never reached the cycle.
  PointCloud<Lidar> assembled(std::size_t lidar, std::int64_t firing_us) {
    std::deque<sensors::LidarSweep>& revolutions = assemblies_[lidar].revolutions;
    while (!revolutions.empty()) {
      sensors::LidarSweep next = std::move(revolutions.front());
      revolutions.pop_front();
      auto* cloud = std::get_if<PointCloud<Lidar>>(&next.seen);
      if (cloud != nullptr && next.device_us == firing_us) return std::move(*cloud);
    }
    throw Error("recording", "misses a revolution", "use another recording");
  }

  const CycleConfig& config_;
  CycleState state_;
  std::deque<PointCloud<Lidar>> clouds_;
  std::map<std::size_t, std::deque<std::vector<float>>> scans_;  ///< ranges, by lidar
  std::map<std::size_t, Assembly> assemblies_ = assemblies();
  InputLook look_;
  PoseEstimate pose_;  ///< of the step at hand, where poses are those of the recording
  bool awaits_state_ = false;
  Stamp begun_{};
  std::string input_;
  std::map<Stamp, std::string> recorded_;
  ReplayResult result_;
};

}  // namespace

namespace {

/// All messages of a run, in order.
void play(const fs::path& run, const CycleConfig& config, Player& player) {
  bridge::Input::Sinks sinks;
  sinks.cloud = [&](const std::string&, const bridge::Cloud& cloud) { player.take_cloud(cloud); };
  sinks.scan = [&](const std::string& topic, const bridge::Scan& scan) { player.take_scan(topic, scan); };
  sinks.packets = [&](const std::string& topic, const std::vector<bridge::Packet>& packets) {
    player.take_packets(topic, packets);
  };
  sinks.text = [&](const std::string& topic, const std::string& text) {
    if (topic == kStateTopic) player.take_state(text);
    if (topic == kInputTopic) player.take_input(text);
    if (topic == kCommandTopic) player.take_command(text);
  };
  int expected = 0;
  for (const fs::path& bag : bags_of(run)) {
    if (bag_number(bag) != expected) player.begin_anew();
    expected = bag_number(bag) + 1;
    try {
      bridge::Input input(bag.string());
      input.choose(replayed_topics(config));
      while (input.next(sinks)) {
      }
    } catch (const Error& e) {
      throw Error(bag.string(), e.what(), "");
    } catch (const std::runtime_error& e) {
      throw Error(bag.string(), e.what(), "is it a whole bag? rosbag reindex may mend one that was cut off");
    }
  }
  player.finish();
  if (player.result().steps == 0)
    throw Error(run.string(), "is no recording of a run", "record one: madori run SITE --record");
}

}  // namespace

ReplayResult replay(const fs::path& run, const CycleConfig& config, std::unique_ptr<PoseSource> source) {
  Player player(config, std::move(source));
  play(run, config, player);
  return player.result();
}

void look_at_inputs(const fs::path& run, const CycleConfig& config, const InputLook& look) {
  Player player(config, look);
  play(run, config, player);
}

}  // namespace madori::app
