#pragma once

#include <algorithm>
#include <cmath>

namespace madori::mapping {

/// Natural logarithm of the odds of a probability that is taken for `uncertain` away from 0 and 1 at least.
[[nodiscard]] inline double log_odds(double probability, double uncertain) {
  const double p = std::clamp(probability, uncertain, 1 - uncertain);
  return std::log(p / (1 - p));
}

[[nodiscard]] inline double probability_of(double log_odds) {
  return 1 / (1 + std::exp(-log_odds));
}

}  // namespace madori::mapping
