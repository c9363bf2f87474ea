#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace madori {

/// The bytes of the character that `text` begins with in UTF-8, as RFC 3629 allows them (no overlong form, no
/// surrogate); 0 where it begins with none, or with the zero byte that no text holds.
[[nodiscard]] inline std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(text[at]); };
  if (text.empty() || byte(0) == 0) return 0;
  if (byte(0) < 0x80) return 1;
  if (byte(0) < 0xC2 || byte(0) > 0xF4) return 0;
  const std::size_t length = byte(0) < 0xE0 ? 2 : byte(0) < 0xF0 ? 3 : 4;
  if (text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  const bool overlong = (byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xF0 && byte(1) < 0x90);
  const bool no_character = (byte(0) == 0xED && byte(1) > 0x9F) || (byte(0) == 0xF4 && byte(1) > 0x8F);
  return overlong || no_character ? 0 : length;
}

/// Where a text stops being UTF-8; its size where all of it is.
[[nodiscard]] inline std::size_t utf8_end(std::string_view text) {
  std::size_t at = 0;
  for (std::size_t step = 1; at < text.size() && step > 0; at += step) step = utf8_length(text.substr(at));
  return at;
}

}  // namespace madori
