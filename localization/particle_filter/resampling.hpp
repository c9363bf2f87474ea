#pragma once

#include <cstddef>

namespace madori::localization {

/// Low-variance (systematic) resampling (Probabilistic Robotics, table 4.4): calls `take(i)` `count` times,
/// ascending, i floor or ceil of count * weight times, and count * weight times on average over `offset`
/// uniform in [0, 1), the weights being scaled to sum to one. Precondition: there are some, and their sum is
/// above zero.
template <class Weights, class Take>
void draw_systematically(const Weights& weights, std::size_t count, double offset, Take&& take) {
  double sum = 0.0;
  for (const auto w : weights) sum += w;
  const double per_weight = static_cast<double>(count) / sum;
  double reached = 0.0;
  std::size_t taken = 0;
  for (std::size_t i = 0; i < weights.size() && taken < count; ++i) {
    reached += weights[i] * per_weight;
    const bool last = i + 1 == weights.size();  // takes what rounding left over
    for (; taken < count && (last || static_cast<double>(taken) + offset < reached); ++taken) take(i);
  }
}

}  // namespace madori::localization
