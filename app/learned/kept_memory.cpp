#include "app/learned/kept_memory.hpp"

#include <utility>

#include "localization/memory/memory_file.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"

namespace madori::app {

KeptMemory load_memory(const std::filesystem::path& folder, const mapping::Walls& walls) {
  const auto file = folder / kMemoryFile;
  if (!std::filesystem::exists(file)) return {};
  std::string bytes = mapping::file_content(file);
  auto memory = localization::parse_memory(bytes, mapping::walls_checksum(walls));
  if (memory.ok()) return {std::move(memory).value(), std::move(bytes), ""};
  return {std::nullopt, "", file.string() + " is not used: " + memory.reason() + "; a new one is begun"};
}

void save_memory(const std::filesystem::path& folder, const localization::Memory& memory,
                 const mapping::Walls& walls) {
  mapping::write_file_atomically(folder / kMemoryFile,
                                 localization::memory_bytes(memory, mapping::walls_checksum(walls)));
}

}  // namespace madori::app
