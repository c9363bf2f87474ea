#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "app/cycle/cycle.hpp"
#include "app/recording/bag_room.hpp"

namespace madori::sensors {
class BagWriter;
}

namespace madori::app {

/// Topics of a recording. Those of /madori are std_msgs/String. Revolutions are recorded as the packets that
/// they came in, a few of them thinned for the eye too; whole clouds only where a link knows no packets.
inline constexpr const char* kPacketTopic = "/velodyne_packets";  ///< /velodyne_packets/1 ... of further ones
inline constexpr const char* kEarlierTopic =
    "/velodyne_packets_before";  ///< of the bag before, to begin with
inline constexpr const char* kThinTopic = "/velodyne_points_thin";
inline constexpr const char* kCloudTopic = "/velodyne_points";
inline constexpr const char* kScanTopic = "/scan";  ///< sensor_msgs/LaserScan; /scan/1 ... of further lidars
inline constexpr const char* kTwistTopic = "/cmd_vel";      ///< geometry_msgs/Twist, what the drive was told
inline constexpr const char* kFramesTopic = "/tf";          ///< tf2_msgs/TFMessage: map, odom, base_link
inline constexpr const char* kMountedTopic = "/tf_static";  ///< base_link and its lidars, in each bag
inline constexpr const char* kInputTopic = "/madori/input";
inline constexpr const char* kCommandTopic = "/madori/command";
inline constexpr const char* kStateTopic = "/madori/state";  ///< at the beginning of a bag
inline constexpr const char* kEventTopic = "/madori/event";

/// A lidar's frame: its name in site.yaml, blanks and the like as '_'.
[[nodiscard]] std::string lidar_frame(const LidarModel& lidar);
/// Of the lidar at that place among the vehicle's.
[[nodiscard]] std::string scan_topic(std::size_t lidar);
/// Of one of `lidars`: kPacketTopic or kEarlierTopic, with its number among those that spin.
[[nodiscard]] std::string packet_topic(const char* topic, const std::vector<LidarModel>& lidars,
                                       std::size_t lidar);

struct RecorderOptions {
  std::vector<LidarModel> lidars{};  ///< the vehicle's, in the order in which scans and clouds name them
  double segment_s = 30.0;           ///< a new bag so often
  RoomLimits room;                   ///< the oldest bags go first
  std::size_t max_waiting = 500;     ///< steps (10 s); a slower disk loses steps, which is counted
};

/// A bag can be replayed alone: it begins with what the cycle remembered, and each step holds its pose.
/// Writes every step as ROS 1 bags `folder`/000.bag, 001.bag ... from a thread of its own: lidar packets,
/// odometry, pose, path, input, command, events. At each stop that is not part of an order, hard links in
/// `folder`/stops keep the bag at hand and the one before, and so at least the 30 s before the stop, with a
/// size limit of their own.
class Recorder {
 public:
  Recorder(std::filesystem::path folder, const RecorderOptions& options = {});
  /// Writes what is left.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void add(const CycleInput& input, const CycleOutput& output, const CycleState& state);
  /// Steps that were lost because the disk was too slow or failed.
  [[nodiscard]] std::uint64_t lost() const;
  /// The disk's last complaint, which is logged too; empty when there is none.
  [[nodiscard]] std::string problem() const;

 private:
  struct Record {
    CycleInput input;  ///< without clouds where there are packets
    std::string text;  ///< of the whole input
    std::optional<PointCloud<Lidar>> thinned;
    std::string state;  ///< after the step, where a new bag begins with the next one; else empty
    CycleOutput output;
    PoseEstimate pose;
    OdometryReading odometry;
    std::optional<Path> path;  ///< where it is a new one
    bool stop = false;
  };

  void run(const std::stop_token& stop);
  bool write(const Record& record);
  void write_step(const Record& record);
  void write_packets(const char* topic, const std::vector<sensors::RawPacket>& packets, Stamp at);
  void give_up_segment();
  void remember(const std::vector<sensors::RawPacket>& packets);
  void begin_segment(Stamp at);
  void end_segment();
  void tidy(int ended);
  void tell(const std::string& problem);
  void keep(const std::filesystem::path& bag) const;
  [[nodiscard]] std::filesystem::path bag_name(int number) const;

  std::filesystem::path folder_;
  RecorderOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<Record> waiting_;
  std::uint64_t lost_ = 0;
  std::string problem_;
  // of add()
  bool drove_ = false;
  std::uint32_t path_of_ = 0;
  std::size_t path_size_ = 0;
  Stamp thinned_{};
  Stamp segment_begun_{};
  // of the thread
  std::unique_ptr<sensors::BagWriter> bag_;
  std::deque<sensors::RawPacket> newest_;  ///< a little more than a revolution
  int number_ = 0;
  bool keep_ = false;
  std::jthread thread_;
};

}  // namespace madori::app
