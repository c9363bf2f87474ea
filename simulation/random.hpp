#pragma once

#include <cstdint>

namespace madori::simulation {

/// SplitMix64 (Steele, Lea, Flood 2014) started from (seed, stream, counter): every packet of every device
/// draws from its own sequence, so that no draw depends on what else happened before it. The same bits
/// everywhere, which the standard library's distributions do not promise.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter)
      : state_(mix(mix(mix(seed + kGolden) + stream) + counter)) {}

  std::uint64_t next() {
    state_ += kGolden;
    return mix(state_);
  }
  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, count). Precondition: count > 0.
  std::uint64_t below(std::uint64_t count) { return next() % count; }

 private:
  static constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;
  static constexpr std::uint64_t mix(std::uint64_t x) {
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
    return x ^ (x >> 31U);
  }
  std::uint64_t state_;
};

/// A standard normal number from 32 random bits, by a table of quantiles (8,192, interpolated; beyond 3.9
/// sigma nothing is drawn). One table look-up: a lidar needs 300,000 of them a second.
[[nodiscard]] float normal_from_bits(std::uint32_t bits);

}  // namespace madori::simulation
