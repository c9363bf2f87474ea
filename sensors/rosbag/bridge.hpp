#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

/// ROS 1 bags without ROS types, written by ROS' library and read by our own BagFile. This header and
/// bridge_output.cpp are C++17, because the message headers need it: they include nothing of core. Everybody
/// else uses reader.hpp and writer.hpp.
namespace madori::sensors::rosbag_bridge {

struct Scan {
  std::int64_t stamp_ns = 0;
  std::string frame;
  float angle_min = 0.0F, angle_increment = 0.0F, time_increment = 0.0F, range_min = 0.0F, range_max = 0.0F;
  std::vector<float> ranges, intensities;
};

struct Pose {
  std::int64_t stamp_ns = 0;
  double x = 0.0, y = 0.0, z = 0.0;
  double qx = 0.0, qy = 0.0, qz = 0.0, qw = 1.0;
  std::vector<double> covariance;  ///< 36 numbers, or none
};

struct Field {
  std::string name;
  std::uint32_t offset = 0, count = 1;
  std::uint8_t type = 0;  ///< sensor_msgs/PointField
};

struct Cloud {
  std::int64_t stamp_ns = 0;
  std::string frame;
  std::uint32_t width = 0, height = 1, point_step = 0, row_step = 0;
  bool big_endian = false;
  std::vector<Field> fields;
  std::vector<std::uint8_t> data;
};

/// Where a frame lies in its parent: geometry_msgs/TransformStamped.
struct FrameIn {
  std::string parent, child;
  Pose pose;
};

struct Packet {
  std::int64_t received_ns = 0;
  std::vector<std::uint8_t> bytes;  ///< 1206 of a VLP-16
};

enum class Kind { Scan, Cloud, Odometry, Text, Packets };

struct Topic {
  std::string name;
  Kind kind = Kind::Scan;
};

/// Every function throws std::runtime_error with the reason.
class Input {
 public:
  explicit Input(const std::string& file);
  ~Input();
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// Topics of these kinds.
  [[nodiscard]] std::vector<Topic> topics() const;
  /// Types of messages that are not read.
  [[nodiscard]] std::set<std::string> other_types() const;
  /// Reads these topics only, in the order of recording.
  void choose(const std::vector<std::string>& topics);
  /// By chosen topic: the stamp in the header before the time of recording, ns, of up to `most` messages that
  /// are spread over the bag. Of messages with a header only.
  [[nodiscard]] std::map<std::string, std::vector<std::int64_t>> stamps_before_recording(std::size_t most);

  struct Sinks {
    std::function<void(const std::string& topic, const Scan&)> scan;
    std::function<void(const std::string& topic, const Cloud&)> cloud;
    std::function<void(const std::string& topic, const Pose&)> odometry;
    std::function<void(const std::string& topic, const std::string& text)> text;
    std::function<void(const std::string& topic, const std::vector<Packet>& packets)> packets;
  };
  /// Hands the next message to its sink; false at the end.
  bool next(const Sinks& sinks);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

class Output {
 public:
  explicit Output(const std::string& file);  ///< its chunks are packed by LZ4
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void write(const std::string& topic, std::int64_t stamp_ns, const Scan& scan);
  void write_twist(const std::string& topic, std::int64_t stamp_ns, double linear_mps, double angular_radps);
  void write(const std::string& topic, const Cloud& cloud);
  void write(const std::string& topic, std::int64_t stamp_ns, const std::string& frame,
             const std::vector<Packet>& packets);  ///< velodyne_msgs/VelodyneScan
  /// tf2_msgs/TFMessage; `latched`: whoever plays the bag hands it to all who ask later, too.
  void write_frames(const std::string& topic, std::int64_t stamp_ns, const std::vector<FrameIn>& frames,
                    bool latched);
  void write_odometry(const std::string& topic, const Pose& pose);
  void write_estimate(const std::string& topic, const Pose& pose);
  void write_path(const std::string& topic, std::int64_t stamp_ns, const std::vector<Pose>& poses);
  void write_text(const std::string& topic, std::int64_t stamp_ns, const std::string& text);
  /// Writes the index; without it the bag must be reindexed.
  void close();

 private:
  void close_anyhow();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace madori::sensors::rosbag_bridge
