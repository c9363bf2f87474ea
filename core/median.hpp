#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace madori {

/// The middle value, of an even count the upper of the two middle ones. Reorders `values`, of which there is
/// at least one.
template <class Values>
[[nodiscard]] typename Values::value_type median_of(Values& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The value of rank `share` (0..1) of the others, rounded down; 0 of none.
[[nodiscard]] inline double percentile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace madori
