#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "localization/memory/memory.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

inline constexpr const char* kMemoryFile = "memory.bin";

/// What an earlier drive remembered of the building.
struct KeptMemory {
  std::optional<localization::Memory> memory;
  std::string bytes;    ///< of the file; empty without one
  std::string message;  ///< why a file that is there is not used, for people
};
/// Reads `folder`/memory.bin. One that is damaged, or of other walls, is no error: a new one is begun.
[[nodiscard]] KeptMemory load_memory(const std::filesystem::path& folder, const mapping::Walls& walls);

/// Writes the file atomically. Throws Error (disk full, no permission).
void save_memory(const std::filesystem::path& folder, const localization::Memory& memory,
                 const mapping::Walls& walls);

}  // namespace madori::app
