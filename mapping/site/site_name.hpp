#pragma once

#include <algorithm>
#include <filesystem>
#include <string>

namespace madori::mapping {

/// Whether a file of a site may have this name: a relative path that stays in the site, as it is written
/// shortest, without control characters. Names come from other computers, too, by a backup.
[[nodiscard]] inline bool is_site_name(const std::string& name) {
  const std::filesystem::path path(name);
  const bool printable = std::ranges::none_of(
      name, [](unsigned char c) { return c < 0x20 || c == 0x7F; });  // a change's journal is lines of names
  return printable && !name.empty() && name.back() != '/' && path.is_relative() &&
         path == path.lexically_normal() && path != "." && *path.begin() != "..";
}

}  // namespace madori::mapping
