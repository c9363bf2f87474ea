#pragma once

#include <array>
#include <cstdio>
#include <map>
#include <string>

namespace madori {

/// A number as people read it in such a text.
[[nodiscard]] inline std::string two_decimals(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

/// The text with every `{name}` replaced by its value; values are not searched again.
[[nodiscard]] inline std::string fill_in(std::string text, const std::map<std::string, std::string>& values) {
  for (const auto& [name, value] : values) {
    const std::string placeholder = "{" + name + "}";
    for (auto at = text.find(placeholder); at != std::string::npos;
         at = text.find(placeholder, at + value.size()))
      text.replace(at, placeholder.size(), value);
  }
  return text;
}

}  // namespace madori
