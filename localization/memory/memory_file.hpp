#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "localization/memory/memory.hpp"

namespace madori::localization {

/// The memory as bytes for a file beside the drawing that it lies on. Little-endian: "MADORIMM", u32 version,
/// u64 checksum of the walls (mapping::walls_checksum), the keyframes with their poses and scans (single
/// precision), the factors, and an FNV-1a checksum over all of it.
[[nodiscard]] std::string memory_bytes(const Memory& memory, std::uint64_t walls);

/// Reads them back. Refused, with the reason: bytes that are cut short or changed, another version, other
/// walls, numbers that are not finite or no places, factors between keyframes that are not there.
[[nodiscard]] Result<Memory> parse_memory(std::string_view bytes, std::uint64_t walls,
                                          const MemoryOptions& options = {});

}  // namespace madori::localization
