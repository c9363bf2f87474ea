#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/result.hpp"

namespace madori::hmi {

/// JSON from outside; a discarded value for malformed text and for nesting deeper than any message of the
/// API, on which the destructor of a tree would run out of stack.
[[nodiscard]] inline nlohmann::json parse_json(const std::string& text) {
  constexpr int kMostDepth = 32;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMostDepth) return nlohmann::json(nlohmann::json::value_t::discarded);
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return nlohmann::json::parse(text, nullptr, false);
}

/// A whole number that fits. Throws Error on fractions, on other types and beyond the type's range, where
/// get<int>() would make something up.
template <class Integer>
[[nodiscard]] Integer whole_number(const nlohmann::json& value) {
  const bool fits = value.is_number_unsigned()
                        ? std::in_range<Integer>(value.get<std::uint64_t>())
                        : value.is_number_integer() && std::in_range<Integer>(value.get<std::int64_t>());
  if (!fits)
    throw Error(value.dump().substr(0, 40), "is no whole number that makes sense here", "correct it");
  return value.get<Integer>();
}

}  // namespace madori::hmi
