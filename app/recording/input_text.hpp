#pragma once

#include <string>

#include "app/cycle/cycle.hpp"

namespace madori::app {

/// One step's input without its revolutions, as a line of JSON; every number comes back to the last bit.
[[nodiscard]] std::string input_text(const CycleInput& input);
/// The same back; `clouds` stays empty. Throws Error on what no recorder wrote.
[[nodiscard]] CycleInput input_from_text(const std::string& text);
/// How many revolutions belong to the step.
[[nodiscard]] std::size_t clouds_of_text(const std::string& text);

/// What the drive was told at `now`, to compare bit for bit.
[[nodiscard]] std::string command_text(const CycleOutput& output, Stamp now);
/// The `now` of such a text; throws Error on what no recorder wrote.
[[nodiscard]] Stamp stamp_of_command(const std::string& text);

}  // namespace madori::app
