#pragma once

#include <optional>
#include <string>

#include "core/velocity_command.hpp"

namespace madori::hmi {

/// What a panel may say on the live socket: one of the two.
struct LiveCommand {
  std::optional<VelocityCommand> jog;
  std::string editing;  ///< where there is no jog
};

/// LiveCommand of hmi/schema: {"jog": {"linear": m/s, "angular": rad/s}}, both finite and at most 5 in size,
/// or
/// {"editing": "walls"}; nothing for anything else.
[[nodiscard]] std::optional<LiveCommand> parse_live_command(const std::string& text);

}  // namespace madori::hmi
