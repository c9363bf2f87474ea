#pragma once

#include <cmath>
#include <random>
#include <vector>

namespace madori::training {

/// The dice of one plan: the same seed throws the same on every platform (the distributions of the standard
/// library do not).
class Chance {
 public:
  explicit Chance(unsigned seed) : engine_(seed) {}
  double between(double a, double b) {
    return a + (b - a) * static_cast<double>(engine_() >> 5U) / 134217728.0;
  }
  /// Even in the logarithm: as many small ones as large ones.
  double scaled(double a, double b) { return a * std::pow(b / a, between(0, 1)); }
  bool one_in(double p) { return between(0, 1) < p; }
  int below(int count) { return static_cast<int>(between(0, count)); }
  template <class T>
  const T& of(const std::vector<T>& choices) {
    return choices[static_cast<std::size_t>(below(static_cast<int>(choices.size())))];
  }

 private:
  std::mt19937 engine_;
};

}  // namespace madori::training
