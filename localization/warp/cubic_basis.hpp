#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace madori::localization {

/// Weights of the four control points around a place on a line of uniform cubic B-splines: of `first` to
/// first + 3.
struct CubicBasis {
  int first = 0;
  std::array<double, 4> weight{};
  std::array<double, 4> slope{};  ///< of the weight, by the place in spacings

  /// `u` in spacings from control point 0.
  explicit CubicBasis(double u) {
    const double cell = std::floor(u);
    const double t = u - cell;
    const double s = 1.0 - t;
    first = static_cast<int>(cell) - 1;
    weight = {s * s * s / 6.0, (4.0 - 3.0 * t * t * (2.0 - t)) / 6.0, (4.0 - 3.0 * s * s * (2.0 - s)) / 6.0,
              t * t * t / 6.0};
    slope = {-0.5 * s * s, -2.0 * t + 1.5 * t * t, 2.0 * s - 1.5 * s * s, 0.5 * t * t};
  }
};

/// Calls visit(control point, weight, slope along u, slope along v) for those of a lattice, row by row, that
/// reach the place (u, v); slopes by spacing.
template <class Visit>
void visit_controls(int width, int height, double u, double v, Visit&& visit) {
  const CubicBasis x(u);
  const CubicBasis y(v);
  for (std::size_t j = 0; j < 4; ++j) {
    const int row = y.first + static_cast<int>(j);
    if (row < 0 || row >= height) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      const int column = x.first + static_cast<int>(i);
      if (column < 0 || column >= width) continue;
      visit(row * width + column, x.weight[i] * y.weight[j], x.slope[i] * y.weight[j],
            x.weight[i] * y.slope[j]);
    }
  }
}

}  // namespace madori::localization
