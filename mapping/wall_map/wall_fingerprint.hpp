#pragma once

#include <cstdint>
#include <string>

#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {

/// A number that differs when the text of walls.csv does (FNV-1a): what was learned on other walls is
/// recognized by it.
[[nodiscard]] std::uint64_t walls_checksum(const Walls& walls);
/// The same as sixteen hexadecimal digits.
[[nodiscard]] std::string walls_fingerprint(const Walls& walls);

}  // namespace madori::mapping
