#include "app/recording/replay.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "app/recording/input_text.hpp"
#include "app/recording/recorder.hpp"
#include "core/result.hpp"
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
  std::sort(bags.begin(), bags.end());
  if (bags.empty()) throw Error(run.string(), "holds no bag", "name a folder below SITE/runs");
  return bags;
}

/// Feeds recorded steps to the cycle and compares its commands.
class Player {
 public:
  Player(const CycleConfig& config, std::unique_ptr<PoseSource> source)
      : config_(config), state_(config, std::move(source)) {}

  void take_cloud(const bridge::Cloud& message) {
    auto cloud = sensors::cloud_from_fields(message);
    if (!cloud)
      throw Error("recording", "holds a damaged revolution: " + cloud.reason(), "use another recording");
    clouds_.push_back(std::move(cloud).value());
  }
  /// A step is run when the next one begins: messages of the same moment may stand in any order.
  void take_input(const std::string& text) {
    finish();
    input_ = text;
  }
  void take_command(const std::string& text) { recorded_[stamp_of_command(text)] = text; }
  void finish() {
    if (input_.empty()) return;
    const CycleInput input = next_input();
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
  CycleInput next_input() {
    CycleInput input = input_from_text(input_);
    const std::size_t count = clouds_of_text(input_);
    if (clouds_.size() < count) throw Error("recording", "misses a revolution", "use another recording");
    for (std::size_t i = 0; i < count; ++i) {
      input.clouds.push_back(std::move(clouds_.front()));
      clouds_.pop_front();
    }
    return input;
  }

  const CycleConfig& config_;
  CycleState state_;
  std::deque<PointCloud<Lidar>> clouds_;
  Stamp begun_{};
  std::string input_;
  std::map<Stamp, std::string> recorded_;
  ReplayResult result_;
};

}  // namespace

ReplayResult replay(const fs::path& run, const CycleConfig& config, std::unique_ptr<PoseSource> source) {
  Player player(config, std::move(source));
  bridge::Input::Sinks sinks;
  sinks.cloud = [&](const std::string&, const bridge::Cloud& cloud) { player.take_cloud(cloud); };
  sinks.text = [&](const std::string& topic, const std::string& text) {
    if (topic == kInputTopic) player.take_input(text);
    if (topic == kCommandTopic) player.take_command(text);
  };
  for (const fs::path& bag : bags_of(run)) {
    try {
      bridge::Input input(bag.string());
      input.choose({kCloudTopic, kInputTopic, kCommandTopic});
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
  return player.result();
}

}  // namespace madori::app
