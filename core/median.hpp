#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace madori {

/// The middle value, of an even count the upper of the two middle ones. Reorders `values`, of which there is
/// at least one.
template <class T>
[[nodiscard]] T median_of(std::vector<T>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace madori
