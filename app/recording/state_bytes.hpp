#pragma once

#include <string>

#include "app/cycle/cycle.hpp"

namespace madori::app {

/// Everything that the cycle remembers, but localization, as bytes of this machine: what a recording needs so
/// that a replay can begin in its middle.
[[nodiscard]] std::string state_bytes(const CycleState& state);
/// Puts it back. Throws Error where the bytes are of another Madori.
void restore_state(CycleState& state, const std::string& bytes, const CycleConfig& config);

}  // namespace madori::app
