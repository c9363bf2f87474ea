#pragma once

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>

namespace madori::app {

/// A number from `least` to `most`, both inclusive. CLI::Range takes `nan` too: it is neither below nor
/// above.
template <class T>
[[nodiscard]] CLI::Validator within(T least, T most) {
  const auto check = [least, most](const std::string& text) {
    T value{};
    if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return std::string();
    std::ostringstream wrong;
    wrong << "Value " << text << " not in range " << least << " to " << most;
    return wrong.str();
  };
  return {check, CLI::Range(least, most).get_description(), ""};
}

}  // namespace madori::app
