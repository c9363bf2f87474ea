#include "app/recording/input_text.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "core/result.hpp"

namespace madori::app {
namespace {

using nlohmann::json;

/// The bits of a number: JSON knows no infinity, and a speed limit may be infinite.
std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}
double from_bits(const json& value) {
  return std::bit_cast<double>(value.get<std::uint64_t>());
}

json status_json(const control::wire::Status& status) {
  std::array<std::uint8_t, control::wire::kMaxFrame> frame{};
  const std::size_t size = control::wire::encode(status, frame.data());
  return std::vector<std::uint8_t>(frame.data(), frame.data() + size - 1);
}
control::wire::Status status_from(const json& value) {
  const auto frame = value.get<std::vector<std::uint8_t>>();
  control::wire::Status status;
  if (control::wire::decode(frame.data(), frame.size(), status) != control::wire::Verdict::Good)
    throw Error("recording", "holds a damaged status of the drive", "use another recording");
  return status;
}

json word_json(const OperatorCommand& command) {
  json word = {static_cast<int>(command.word), bits(command.jog.linear_mps), bits(command.jog.angular_radps)};
  if (command.word != OperatorWord::SetPose) return word;
  const GivenPose& p = command.given_pose;
  for (const double v : {p.position.x_m, p.position.y_m, p.yaw_rad, p.sigma.position_m, p.sigma.yaw_rad})
    word.push_back(bits(v));
  return word;
}
OperatorCommand word_from(const json& word) {
  OperatorCommand command{
      static_cast<OperatorWord>(word.at(0).get<int>()), {from_bits(word.at(1)), from_bits(word.at(2))}, {}};
  if (command.word == OperatorWord::SetPose)
    command.given_pose = {{from_bits(word.at(3)), from_bits(word.at(4))},
                          from_bits(word.at(5)),
                          {from_bits(word.at(6)), from_bits(word.at(7))}};
  return command;
}

json order_json(const Order& order) {
  json stops = json::array();
  for (const OrderStop& stop : order.stops)
    stops.push_back({stop.node, static_cast<int>(stop.action), bits(stop.wait_s)});
  return {{"id", order.id},         {"stops", stops},
          {"repeat", order.repeat}, {"state", static_cast<int>(order.state)},
          {"round", order.round},   {"next", order.next_stop},
          {"note", order.note}};
}
Order order_from(const json& value) {
  Order order{value.at("id"),     {},
              value.at("repeat"), static_cast<OrderState>(value.at("state").get<int>()),
              value.at("round"),  value.at("next"),
              value.at("note")};
  for (const json& stop : value.at("stops"))
    order.stops.push_back(
        {stop.at(0), static_cast<StopAction>(stop.at(1).get<int>()), from_bits(stop.at(2))});
  return order;
}

json detour_json(const planning::DetourAnswer& answer) {
  json value{{"id", answer.id}, {"rejoin", answer.rejoin}, {"reason", answer.reason}};
  if (!answer.path) return value;
  json points = json::array();
  for (const PathPoint& p : answer.path->points)
    points.push_back({bits(p.position.x_m), bits(p.position.y_m), bits(p.heading_rad),
                      bits(p.curvature_per_m), bits(p.speed_limit_mps), p.reverse});
  value["path"] = std::move(points);
  return value;
}
planning::DetourAnswer detour_from(const json& value) {
  planning::DetourAnswer answer{value.at("id"), std::nullopt, value.at("rejoin"), value.at("reason")};
  if (!value.contains("path")) return answer;
  answer.path.emplace();
  for (const json& p : value.at("path"))
    answer.path->points.push_back({{from_bits(p.at(0)), from_bits(p.at(1))},
                                   from_bits(p.at(2)),
                                   from_bits(p.at(3)),
                                   from_bits(p.at(4)),
                                   p.size() > 5 && p.at(5).get<bool>()});
  return answer;
}

/// Stamp of every revolution, and its first firing where its packets are recorded.
json clouds_json(const CycleInput& input) {
  json clouds = json::array();
  for (std::size_t i = 0; i < input.clouds.size(); ++i) {
    clouds.push_back({input.clouds[i].stamp.time_since_epoch().count()});
    if (!has_packets(input) && input.clouds[i].lidar == 0) continue;
    clouds.back().push_back(has_packets(input) ? json(input.firings_us[i]) : json());
    if (input.clouds[i].lidar > 0) clouds.back().push_back(input.clouds[i].lidar);
  }
  return clouds;
}

/// All of a scan but its ranges, which stand in the bag: there an angle is a float.
json scans_json(const CycleInput& input) {
  json scans = json::array();
  for (const LaserScan& scan : input.scans)
    scans.push_back({scan.stamp.time_since_epoch().count(), scan.lidar, scan.beam_period.count(),
                     bits(scan.angle_min_rad), bits(scan.angle_step_rad), bits(scan.range_max_m)});
  return scans;
}

/// Sine and cosine are kept too: made again from the yaw they could differ in the last bit.
using TransformBits = std::array<std::uint64_t, 5>;

template <class To, class From>
TransformBits bits(const Transform2<To, From>& transform) {
  static_assert(std::is_trivially_copyable_v<Transform2<To, From>> &&
                sizeof transform == sizeof(TransformBits));
  TransformBits numbers{};
  std::memcpy(numbers.data(), &transform, sizeof numbers);
  return numbers;
}

template <class To, class From>
void take_bits(const json& from, Transform2<To, From>& transform) {
  const auto numbers = from.get<TransformBits>();
  std::memcpy(static_cast<void*>(&transform), numbers.data(), sizeof numbers);
}

json pose_json(const PoseEstimate& pose) {
  std::array<std::uint64_t, 9> covariance{};
  std::memcpy(covariance.data(), pose.covariance.data(), sizeof covariance);
  return {pose.stamp.time_since_epoch().count(),
          bits(pose.map_from_base),
          covariance,
          static_cast<int>(pose.health.state),
          pose.health.reason,
          std::bit_cast<std::uint64_t>(pose.health.place),
          bits(pose.moved)};
}

json parsed(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  if (value.is_discarded())
    throw Error("recording", "holds a step that is no JSON", "was it written by a newer Madori?");
  return value;
}

}  // namespace

bool has_packets(const CycleInput& input) {
  return !input.clouds.empty() && input.firings_us.size() == input.clouds.size();
}

std::string input_text(const CycleInput& input, const PoseEstimate& pose) {
  json value{{"now", input.now.time_since_epoch().count()},
             {"clouds", clouds_json(input)},
             {"pose", pose_json(pose)}};
  if (!input.scans.empty()) value["scans"] = scans_json(input);
  for (const auto& status : input.drive) value["drive"].push_back(status_json(status));
  if (input.thinking) value["thinking"] = true;
  if (input.protective_stop) value["protective_stop"] = true;
  if (input.drive_behind > Duration{}) value["drive_behind"] = input.drive_behind.count();
  for (const auto& command : input.commands) value["words"].push_back(word_json(command));
  if (input.order) value["order"] = order_json(*input.order);
  if (input.detour) value["detour"] = detour_json(*input.detour);
  return value.dump();
}

CycleInput input_from_text(const std::string& text) {
  const json value = parsed(text);
  try {
    CycleInput input;
    input.now = Stamp(Duration(value.at("now").get<std::int64_t>()));
    for (const json& status : value.value("drive", json::array())) input.drive.push_back(status_from(status));
    input.thinking = value.value("thinking", false);
    input.protective_stop = value.value("protective_stop", false);
    input.drive_behind = Duration(value.value("drive_behind", Duration::rep{}));
    for (const json& word : value.value("words", json::array())) input.commands.push_back(word_from(word));
    if (value.contains("order")) input.order = order_from(value.at("order"));
    if (value.contains("detour")) input.detour = detour_from(value.at("detour"));
    return input;
  } catch (const json::exception& e) {
    throw Error("recording", e.what(), "was it written by a newer Madori?");
  }
}

std::vector<RecordedCloud> clouds_of_text(const std::string& text) {
  const json value = parsed(text);
  try {
    std::vector<RecordedCloud> clouds;
    for (const json& cloud : value.at("clouds")) {
      clouds.push_back({Stamp(Duration(cloud.at(0).get<std::int64_t>())), std::nullopt, 0});
      if (cloud.size() > 1 && !cloud.at(1).is_null())
        clouds.back().firing_us = cloud.at(1).get<std::int64_t>();
      if (cloud.size() > 2) clouds.back().lidar = cloud.at(2).get<std::size_t>();
    }
    return clouds;
  } catch (const json::exception& e) {
    throw Error("recording", e.what(), "was it written by another Madori?");
  }
}

std::vector<LaserScan> scans_of_text(const std::string& text) {
  const json value = parsed(text);
  try {
    std::vector<LaserScan> scans;
    for (const json& from : value.value("scans", json::array())) {
      LaserScan& scan = scans.emplace_back();
      scan.stamp = Stamp(Duration(from.at(0).get<std::int64_t>()));
      scan.lidar = from.at(1).get<std::size_t>();
      scan.beam_period = Duration(from.at(2).get<std::int64_t>());
      scan.angle_min_rad = from_bits(from.at(3));
      scan.angle_step_rad = from_bits(from.at(4));
      scan.range_max_m = from_bits(from.at(5));
    }
    return scans;
  } catch (const json::exception& e) {
    throw Error("recording", e.what(), "was it written by another Madori?");
  }
}

PoseEstimate pose_from_text(const std::string& text) {
  const json value = parsed(text);
  try {
    const json& from = value.at("pose");
    PoseEstimate pose;
    pose.stamp = Stamp(Duration(from.at(0).get<std::int64_t>()));
    take_bits(from.at(1), pose.map_from_base);
    const auto covariance = from.at(2).get<std::array<std::uint64_t, 9>>();
    std::memcpy(pose.covariance.data(), covariance.data(), sizeof covariance);
    pose.health = {static_cast<LocalizationState>(from.at(3).get<int>()), from.at(4),
                   std::bit_cast<double>(from.at(5).get<std::uint64_t>())};
    take_bits(from.at(6), pose.moved);
    return pose;
  } catch (const json::exception& e) {
    throw Error("recording", e.what(), "was it written by another Madori?");
  }
}

std::string command_text(const CycleOutput& output, Stamp now) {
  return json({now.time_since_epoch().count(), bits(output.command.linear_mps),
               bits(output.command.angular_radps), output.enable})
      .dump();
}

Stamp stamp_of_command(const std::string& text) {
  const json value = parsed(text);
  if (!value.is_array() || value.empty() || !value[0].is_number_integer())
    throw Error("recording", "holds a command that is none", "was it written by a newer Madori?");
  return Stamp(Duration(value[0].get<std::int64_t>()));
}

}  // namespace madori::app
