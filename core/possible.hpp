#pragma once

#include <cmath>

namespace madori {

/// Of metres or radians that were read: beyond it a number is garbage.
inline constexpr double kLargestRead = 1e7;

/// False for what is no number, too.
[[nodiscard]] inline bool is_possible(double metres_or_radians) {
  return std::abs(metres_or_radians) <= kLargestRead;
}

}  // namespace madori
