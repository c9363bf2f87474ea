#pragma once

#include <optional>
#include <string>

#include "core/velocity_command.hpp"

namespace madori::hmi {

/// {"jog": {"linear": m/s, "angular": rad/s}}, both finite and at most 5 in size; nothing for anything else.
[[nodiscard]] std::optional<VelocityCommand> parse_jog(const std::string& text);

}  // namespace madori::hmi
