#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace madori::fuzz {

using Bytes = std::vector<std::uint8_t>;

inline void save(const std::filesystem::path& file, const auto& bytes) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

/// What is kept of a site: days, the journal of a drive, site.yaml, backups and what was learned.
void kept_seeds(const std::filesystem::path& folder);

}  // namespace madori::fuzz
