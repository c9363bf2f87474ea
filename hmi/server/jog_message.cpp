#include "hmi/server/jog_message.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace madori::hmi {

std::optional<VelocityCommand> parse_jog(const std::string& text) {
  constexpr double kLimit = 5.0;
  const auto message = nlohmann::json::parse(text, nullptr, false);
  if (!message.is_object() || message.size() != 1 || !message.contains("jog")) return std::nullopt;
  const auto& jog = message["jog"];
  if (!jog.is_object() || jog.size() != 2) return std::nullopt;
  const auto linear = jog.find("linear");
  const auto angular = jog.find("angular");
  if (linear == jog.end() || angular == jog.end() || !linear->is_number() || !angular->is_number())
    return std::nullopt;
  const VelocityCommand velocity{linear->get<double>(), angular->get<double>()};
  const bool good = std::abs(velocity.linear_mps) <= kLimit && std::abs(velocity.angular_radps) <= kLimit;
  return good ? std::optional(velocity) : std::nullopt;
}

}  // namespace madori::hmi
