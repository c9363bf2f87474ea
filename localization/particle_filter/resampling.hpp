#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "localization/particle_filter/particles.hpp"

namespace madori::localization {

/// Size of the bins in which the spread of the particles is counted.
struct KldOptions {
  double bin_m = 0.25;
  double bin_rad = 0.175;  ///< 10 degrees
  double epsilon =
      0.05;          ///< Kullback-Leibler distance allowed between the particles and what they stand for ...
  double z = 2.326;  ///< ... with this quantile of certainty (2.326 = 99 %)
};

/// 1 / sum of squared weights: how many particles the weights are worth. Precondition: they sum to one.
[[nodiscard]] double effective_size(const Particles& particles);

/// Number of particles for a spread over `bins` occupied bins (Fox, KLD-sampling, NIPS 2001, Eq. 7).
[[nodiscard]] std::size_t kld_number(std::size_t bins, const KldOptions& options);

/// Counts the bins that hold particles of more than a millionth of the mean weight.
class BinCounter {
 public:
  [[nodiscard]] std::size_t count(const Particles& particles, const KldOptions& options);

 private:
  std::vector<std::uint64_t> table_;  ///< open addressing; keys carry the round, so that it needs no clearing
  std::uint64_t round_ = 0;
};

/// Low-variance (systematic) resampling (Probabilistic Robotics, table 4.4): calls `take(i)` `count` times, i
/// floor or ceil of count * weight times, ascending. Precondition as below.
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

/// Low-variance (systematic) resampling into `out`, `count` particles of equal weight (Probabilistic
/// Robotics, table 4.4): particle i is taken floor or ceil of count * weight times, and count * weight times
/// on average over `offset` uniform in [0, 1). Precondition: the weights sum to one up to rounding, and there
/// are some.
void resample(const Particles& in, std::size_t count, double offset, Particles& out);

}  // namespace madori::localization
