#include <algorithm>
#include <set>

#include "sensors/rosbag/bag_file.hpp"
#include "sensors/rosbag/bridge.hpp"
#include "sensors/rosbag/messages.hpp"

namespace madori::sensors::rosbag_bridge {

struct Input::State {
  BagFile bag;
  std::vector<BagFile::Place> places;
  std::size_t next = 0;
};

Input::Input(const std::string& file) : state_(new State{BagFile(file), {}, 0}) {}
Input::~Input() = default;

std::vector<Topic> Input::topics() const {
  std::vector<Topic> topics;
  for (const auto& [number, connection] : state_->bag.connections()) {
    const auto kind = kind_of(connection.type, connection.md5sum);
    const bool known = std::ranges::find(topics, connection.topic, &Topic::name) != topics.end();
    if (kind && !known) topics.push_back({connection.topic, *kind});
  }
  return topics;
}

std::set<std::string> Input::other_types() const {
  std::set<std::string> types;
  for (const auto& [number, connection] : state_->bag.connections())
    if (!kind_of(connection.type, connection.md5sum)) types.insert(connection.type);
  return types;
}

std::map<std::string, std::vector<std::int64_t>> Input::stamps_before_recording(std::size_t most) {
  const auto& connections = state_->bag.connections();
  std::map<std::string, std::vector<BagFile::Place>> places;
  for (const BagFile::Place& place : state_->places) {
    const auto& from = connections.at(place.connection);
    const auto kind = kind_of(from.type, from.md5sum);
    if (kind && *kind != Kind::Text) places[from.topic].push_back(place);
  }
  std::map<std::string, std::vector<std::int64_t>> before;
  for (const auto& [topic, all] : places) {
    const std::size_t some = std::min(most, all.size());
    for (std::size_t i = 0; i < some; ++i) {
      const BagFile::Place& place = all[i * all.size() / some];
      before[topic].push_back(header_stamp_ns(state_->bag.message(place)) -
                              static_cast<std::int64_t>(place.recorded_ns));
    }
  }
  return before;
}

void Input::choose(const std::vector<std::string>& topics) {
  std::set<std::uint32_t> chosen;
  for (const auto& [number, connection] : state_->bag.connections())
    if (std::ranges::find(topics, connection.topic) != topics.end()) chosen.insert(number);
  state_->places = state_->bag.places(chosen);
  state_->next = 0;
}

bool Input::next(const Sinks& sinks) {
  if (state_->next == state_->places.size()) return false;
  const BagFile::Place& place = state_->places[state_->next++];
  const BagFile::Connection& from = state_->bag.connections().at(place.connection);
  const auto kind = kind_of(from.type, from.md5sum);
  if (!kind) return true;
  const Bytes message = state_->bag.message(place);
  if (*kind == Kind::Scan)
    sinks.scan(from.topic, from.type == kMultiEcho ? first_echoes_from(message) : scan_from(message));
  if (*kind == Kind::Cloud) sinks.cloud(from.topic, cloud_from(message));
  if (*kind == Kind::Odometry) sinks.odometry(from.topic, odometry_from(message));
  if (*kind == Kind::Text && sinks.text) sinks.text(from.topic, text_from(message));
  if (*kind == Kind::Packets && sinks.packets) sinks.packets(from.topic, packets_from(message));
  return true;
}

}  // namespace madori::sensors::rosbag_bridge
