#include "simulation/random.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace madori::simulation {
namespace {

constexpr int kQuantiles = 8192;

/// Phi^-1(p) by Newton's method; p well inside (0, 1).
double normal_quantile(double p) {
  double x = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double density = std::exp(-x * x / 2.0) / std::sqrt(2.0 * std::numbers::pi);
    const double step = (std::erfc(-x / std::numbers::sqrt2) / 2.0 - p) / density;
    x -= std::fmin(std::fmax(step, -0.5), 0.5);
    if (std::abs(step) < 1e-12) break;
  }
  return x;
}

std::array<float, kQuantiles + 1> make_table() {
  std::array<float, kQuantiles + 1> table{};
  for (int i = 0; i <= kQuantiles; ++i)
    table[i] = static_cast<float>(normal_quantile((i + 0.5) / (kQuantiles + 1.0)));
  return table;
}

}  // namespace

float normal_from_bits(std::uint32_t bits) {
  static const auto table = make_table();
  const std::uint32_t index = bits >> 19U;  // 13 bits
  const float fraction = static_cast<float>(bits & 0x7FFFFU) * 0x1p-19F;
  return table[index] + fraction * (table[index + 1] - table[index]);
}

}  // namespace madori::simulation
