#pragma once

#include <sys/stat.h>

#include <array>
#include <cstdint>
#include <filesystem>

namespace madori::mapping {

/// Which file is at a path, and when it was written last: a file that is written atomically is another one.
using FileIdentity = std::array<std::int64_t, 5>;

/// All zero where there is none.
[[nodiscard]] inline FileIdentity file_identity(const std::filesystem::path& file) {
  struct stat s {};
  if (::stat(file.c_str(), &s) != 0) return {};
  return {static_cast<std::int64_t>(s.st_dev), static_cast<std::int64_t>(s.st_ino), s.st_size,
          s.st_mtim.tv_sec, s.st_mtim.tv_nsec};
}

/// Of what a vehicle drives by: site.yaml, walls.csv and the routes.
using SiteIdentity = std::array<FileIdentity, 4>;
[[nodiscard]] inline SiteIdentity site_identity(const std::filesystem::path& site) {
  return {file_identity(site / "site.yaml"), file_identity(site / "walls.csv"),
          file_identity(site / "routes/tree.csv"), file_identity(site / "routes/path.csv")};
}

}  // namespace madori::mapping
