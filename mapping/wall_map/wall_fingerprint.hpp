#pragma once

#include <string>

#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {

/// Sixteen hexadecimal digits that differ when the text of walls.csv does (FNV-1a): what was learned on other
/// walls is recognized by it.
[[nodiscard]] std::string walls_fingerprint(const Walls& walls);

}  // namespace madori::mapping
