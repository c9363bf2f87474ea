#include "localization/particle_filter/sensor_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "localization/particle_filter/sensor_kernel_simd.hpp"

namespace madori::localization {
namespace {

constexpr double kLargest = 32000.0;  // of a beam's coordinates, so that a turned one still fits 16 bits
constexpr int kMostFractionBits = 5;

/// Beams by falling weight class; neighbours of a class stay neighbours, for the cache.
std::vector<std::vector<std::size_t>> by_weight(const ScanPoints& points, const LikelihoodField& field,
                                                std::size_t stride, std::vector<double>& weight) {
  constexpr int kClasses = 8;
  std::vector<std::vector<std::size_t>> classes(kClasses + 1);
  weight.resize(points.size());
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const double range = std::hypot(points.x_m[i], points.y_m[i]);
    if (!std::isfinite(range) || range > kLargest * field.frame().cell_m) continue;
    weight[i] = std::clamp(points.weight_of(i) * field.information(range), 0.0, 1.0);
    classes[static_cast<std::size_t>(kClasses - std::lround(weight[i] * kClasses))].push_back(i);
  }
  classes.pop_back();  // tells nothing
  return classes;
}

}  // namespace

BeamBlocks::BeamBlocks(const ScanPoints& points, const LikelihoodField& field, std::size_t most_beams) {
  const std::size_t stride = 1 + points.size() / (std::max<std::size_t>(most_beams, 1) + 1);
  std::vector<double> weights;
  std::vector<std::size_t> order;
  for (const auto& same : by_weight(points, field, stride, weights))
    order.insert(order.end(), same.begin(), same.end());
  beams_ = order.size();
  const double cells_per_m = 1.0 / field.frame().cell_m;
  double farthest = 0.0;
  for (const std::size_t i : order)
    farthest = std::max(farthest, std::hypot(points.x_m[i], points.y_m[i]) * cells_per_m);
  fraction_bits_ = kMostFractionBits;
  while (fraction_bits_ > 0 && farthest * (1 << fraction_bits_) > kLargest) --fraction_bits_;
  const double units_per_m = cells_per_m * (1 << fraction_bits_);
  for (std::size_t first = 0; first < beams_; first += kBeams) {
    const std::size_t count = std::min(kBeams, beams_ - first);
    double block_weight = 0.0;
    for (std::size_t i = 0; i < kBeams; ++i) {
      const std::size_t beam = order[first + std::min(i, count - 1)];
      x_.push_back(static_cast<std::int16_t>(std::lround(points.x_m[beam] * units_per_m)));
      y_.push_back(static_cast<std::int16_t>(std::lround(points.y_m[beam] * units_per_m)));
      if (i < count) block_weight += weights[beam];
    }
    total_weight_ += block_weight;
    weight_.push_back(static_cast<std::uint32_t>(
        std::max(1L, std::lround(kFullWeight * block_weight / static_cast<double>(count)))));
  }
}

double log_likelihood_per_count(const BeamBlocks& beams, const LikelihoodField& field) {
  const double temper = std::min(1.0, field.model().effective_beams / std::max(beams.total_weight(), 1.0));
  return temper * field.nats_per_count() / BeamBlocks::kFullWeight;
}

namespace {

/// A bound of the table relative to the particle's cell, in units of the beams, saturated: what 16 bits
/// cannot hold no beam can reach.
std::int16_t bound(std::int64_t cells, int fraction_bits) {
  constexpr std::int64_t kLow = std::numeric_limits<std::int16_t>::min();
  constexpr std::int64_t kHigh = std::numeric_limits<std::int16_t>::max();
  return static_cast<std::int16_t>(std::clamp(cells * (std::int64_t{1} << fraction_bits), kLow, kHigh));
}

/// Where one particle stands, in the integers that the kernels share.
SensorKernelPlace place(const Particles& particles, std::size_t i, const LikelihoodField& field, int bits) {
  const mapping::GridFrame& frame = field.frame();
  const double cells_per_m = 1.0 / frame.cell_m;
  const double u = (particles.origin.x_m - frame.origin.x_m + particles.x_m[i]) * cells_per_m;
  const double v = (particles.origin.y_m - frame.origin.y_m + particles.y_m[i]) * cells_per_m;
  SensorKernelPlace at;
  // A particle outside stands on the rim: all its look-ups that fall outside are clutter.
  const double inside_u = u > 0.0 ? std::min(u, frame.width - 1.0) : 0.0;
  const double inside_v = v > 0.0 ? std::min(v, frame.height - 1.0) : 0.0;
  const auto column = static_cast<std::int64_t>(inside_u);
  const auto row = static_cast<std::int64_t>(inside_v);
  at.cell = row * frame.width + column;
  const double units = 1 << bits;
  at.x = static_cast<std::int16_t>((inside_u - static_cast<double>(column)) * units);
  at.y = static_cast<std::int16_t>((inside_v - static_cast<double>(row)) * units);
  constexpr float kOne = 32767.0F;
  at.cos = static_cast<std::int16_t>(std::lrint(kOne * std::cos(particles.yaw_rad[i])));
  at.sin = static_cast<std::int16_t>(std::lrint(kOne * std::sin(particles.yaw_rad[i])));
  at.low_x = bound(-column, bits);
  at.low_y = bound(-row, bits);
  at.high_x = bound(frame.width - 1 - column, bits);
  at.high_y = bound(frame.height - 1 - row, bits);
  return at;
}

SensorKernelBeams kernel_beams(const BeamBlocks& beams, const LikelihoodField& field) {
  return {beams.x().data(),    beams.y().data(),      beams.weight().data(),
          beams.beams(),       beams.fraction_bits(), static_cast<std::int16_t>(field.frame().width),
          field.table().data()};
}

std::uint32_t sum_scalar(const SensorKernelBeams& beams, const SensorKernelPlace& at) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < beams.count; ++i)
    sum += beams.weight[i / BeamBlocks::kBeams] * beams.table[at.cell + table_offset(beams, at, i)];
  return sum;
}

}  // namespace

void sum_counts(const Particles& particles, const BeamBlocks& beams, const LikelihoodField& field,
                std::span<std::uint32_t> sums) {
  if (beams.beams() == 0) {
    std::fill_n(sums.begin(), particles.size(), 0U);
    return;
  }
  const SensorKernelBeams input = kernel_beams(beams, field);
  constexpr std::size_t kChunk = 64;
  SensorKernelPlace places[kChunk];
  for (std::size_t first = 0; first < particles.size(); first += kChunk) {
    const std::size_t count = std::min(kChunk, particles.size() - first);
    for (std::size_t i = 0; i < count; ++i)
      places[i] = place(particles, first + i, field, beams.fraction_bits());
    sum_counts_simd(input, places, count, sums.data() + first);
  }
}

void sum_counts_scalar(const Particles& particles, const BeamBlocks& beams, const LikelihoodField& field,
                       std::span<std::uint32_t> sums) {
  const SensorKernelBeams input = kernel_beams(beams, field);
  for (std::size_t i = 0; i < particles.size(); ++i)
    sums[i] = sum_scalar(input, place(particles, i, field, beams.fraction_bits()));
}

}  // namespace madori::localization
