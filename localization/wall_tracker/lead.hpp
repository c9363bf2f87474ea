#pragma once

#include <algorithm>

namespace madori::localization {

/// By how much one pose led another in the votes cast.
struct Lead {
  double sum = 0.0;
  double squares = 0.0;

  void add(double vote) {
    sum += vote;
    squares += vote * vote;
  }
  [[nodiscard]] double mean(int votes) const { return sum / votes; }
  /// Whether the mean differs from 0 by more than so many of its standard deviations; of two votes or more.
  [[nodiscard]] bool is_sure(int votes, double sigmas) const {
    constexpr double kLeastVariance = 1e-8;
    const double m = mean(votes);
    const double variance = std::max(kLeastVariance, (squares / votes - m * m) / (votes - 1));
    return m * m > sigmas * sigmas * variance;
  }
};

}  // namespace madori::localization
