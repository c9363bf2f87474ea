#include "hmi/server/live_command.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "hmi/server/json_text.hpp"

namespace madori::hmi {
namespace {

std::optional<VelocityCommand> jog_of(const nlohmann::json& jog) {
  constexpr double kLimit = 5.0;
  if (!jog.is_object() || jog.size() != 2) return std::nullopt;
  const auto linear = jog.find("linear");
  const auto angular = jog.find("angular");
  if (linear == jog.end() || angular == jog.end() || !linear->is_number() || !angular->is_number())
    return std::nullopt;
  const VelocityCommand velocity{linear->get<double>(), angular->get<double>()};
  const bool good = std::abs(velocity.linear_mps) <= kLimit && std::abs(velocity.angular_radps) <= kLimit;
  return good ? std::optional(velocity) : std::nullopt;
}

}  // namespace

std::optional<LiveCommand> parse_live_command(const std::string& text) {
  const auto message = parse_json(text);
  if (!message.is_object() || message.size() != 1) return std::nullopt;
  if (const auto jog = message.find("jog"); jog != message.end()) {
    const auto velocity = jog_of(*jog);
    return velocity ? std::optional(LiveCommand{velocity, ""}) : std::nullopt;
  }
  const auto editing = message.find("editing");
  if (editing == message.end() || !editing->is_string()) return std::nullopt;
  return LiveCommand{std::nullopt, editing->get<std::string>()};
}

}  // namespace madori::hmi
