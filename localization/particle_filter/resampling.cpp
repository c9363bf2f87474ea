#include "localization/particle_filter/resampling.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace madori::localization {

double effective_size(const Particles& particles) {
  double squares = 0.0;
  for (const float w : particles.weight) squares += double{w} * w;
  return squares > 0.0 ? 1.0 / squares : 0.0;
}

std::size_t kld_number(std::size_t bins, const KldOptions& options) {
  if (bins < 2) return 1;
  const double k = static_cast<double>(bins) - 1.0;
  const double a = 2.0 / (9.0 * k);
  const double b = 1.0 - a + std::sqrt(a) * options.z;
  return static_cast<std::size_t>(std::ceil(k / (2.0 * options.epsilon) * b * b * b));
}

std::size_t BinCounter::count(const Particles& particles, const KldOptions& options) {
  const std::size_t size = std::bit_ceil(std::max<std::size_t>(2 * particles.size(), 64));
  if (table_.size() < size || ++round_ >= 0xFFFF) {
    table_.assign(std::max(size, table_.size()), 0);
    round_ = 1;
  }
  const std::size_t mask = table_.size() - 1;
  const auto per_m = static_cast<float>(1.0 / options.bin_m);
  const auto per_rad = static_cast<float>(1.0 / options.bin_rad);
  const auto around = static_cast<float>(2.0 * kPi / options.bin_rad);
  const float least = 1e-6F / static_cast<float>(std::max<std::size_t>(particles.size(), 1));
  std::size_t bins = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.weight[i] <= least) continue;
    float turn = particles.yaw_rad[i] * per_rad;
    turn -= around * std::floor(turn / around);
    // 16 bits each for x, y, yaw, round; sites beyond 65536 bins wrap, which costs a count at worst
    const std::uint64_t key =
        (round_ << 48) |
        (static_cast<std::uint64_t>(static_cast<std::int32_t>(particles.x_m[i] * per_m) & 0xFFFF) << 32) |
        (static_cast<std::uint64_t>(static_cast<std::int32_t>(particles.y_m[i] * per_m) & 0xFFFF) << 16) |
        static_cast<std::uint64_t>(static_cast<std::int32_t>(turn) & 0xFFFF);
    std::size_t slot = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ULL) >> 32) & mask;
    while (table_[slot] >> 48 == round_ && table_[slot] != key) slot = (slot + 1) & mask;
    bins += table_[slot] != key;
    table_[slot] = key;
  }
  return bins;
}

void resample(const Particles& in, std::size_t count, double offset, Particles& out) {
  out.origin = in.origin;
  out.resize(count);
  const float weight = 1.0F / static_cast<float>(count);
  std::size_t taken = 0;
  draw_systematically(in.weight, count, offset, [&](std::size_t i) {
    out.x_m[taken] = in.x_m[i];
    out.y_m[taken] = in.y_m[i];
    out.yaw_rad[taken] = in.yaw_rad[i];
    out.weight[taken++] = weight;
  });
}

}  // namespace madori::localization
