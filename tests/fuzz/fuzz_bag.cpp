// A ROS 1 bag, as a log and as a recording. The first byte chooses: 0, the file as it is; else a sound bag
// around messages, whose first byte chooses the type and which 0xFF ends: 1 as they are, 2 packed by bzip2.
#include <cmath>
#include <string>
#include <string_view>

#include "sensors/open_log.hpp"
#include "sensors/rosbag/bridge.hpp"
#include "tests/fuzz/fuzz_file.hpp"
#include "tests/support/made_bag.hpp"

namespace {

using namespace madori;
namespace bridge = sensors::rosbag_bridge;

std::string bag_around(std::string_view rest, const char* compression) {
  std::vector<test::MadeMessage> messages;
  while (!rest.empty()) {
    const std::string_view message = rest.substr(0, rest.find('\xff'));
    rest.remove_prefix(std::min(rest.size(), message.size() + 1));
    if (message.empty()) continue;
    const auto type = static_cast<unsigned char>(message[0]) % std::size(bridge::kMessageTypes);
    messages.push_back({type, std::string(message.substr(1))});
  }
  return test::made_bag(messages, compression);
}

void read_as_log(const std::filesystem::path& file) {
  try {
    const auto log = sensors::open_log(file, {});
    while (const auto record = log->next()) {
      if (const auto* odometry = std::get_if<OdometryReading>(&*record))
        fuzz::require(odometry->odom_from_base.is_finite());
      if (const auto* cloud = std::get_if<sensors::CloudRecord>(&*record))
        for (const CloudPoint& p : cloud->cloud.points)
          fuzz::require(std::isfinite(p.x_m + p.y_m + p.z_m + p.time_offset_s));
    }
  } catch (const Error& e) {
    fuzz::require(e.what()[0] != '\0');
  }
}

void read_as_recording(const std::filesystem::path& file) {
  bridge::Input::Sinks sinks;
  sinks.scan = [](const std::string&, const bridge::Scan&) {};
  sinks.cloud = [](const std::string&, const bridge::Cloud&) {};
  sinks.odometry = [](const std::string&, const bridge::Pose&) {};
  sinks.text = [](const std::string&, const std::string&) {};
  sinks.packets = [](const std::string&, const std::vector<bridge::Packet>& packets) {
    for (const auto& packet : packets) fuzz::require(packet.bytes.size() == 1206);
  };
  try {
    bridge::Input input(file.string());
    std::vector<std::string> topics;
    for (const auto& topic : input.topics()) topics.push_back(topic.name);
    input.choose(topics);
    while (input.next(sinks)) {
    }
  } catch (const std::runtime_error& e) {
    fuzz::require(e.what()[0] != '\0');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const fuzz::MemoryFile file(".bag");
  if (size == 0) return 0;
  const std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string bytes =
      data[0] == 0 ? std::string(rest) : bag_around(rest, data[0] % 2 == 1 ? "none" : "bz2");
  file.write(bytes);
  read_as_log(file.path());
  read_as_recording(file.path());
  return 0;
}
