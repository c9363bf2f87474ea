#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "localization/particle_filter/likelihood_field.hpp"
#include "localization/particle_filter/particles.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// A scan as the sensor kernel reads it: 16-bit coordinates in fractions of a cell, and beams of like weight
/// in blocks that share their mean weight.
class BeamBlocks {
 public:
  static constexpr std::size_t kBeams = 32;         ///< of a block
  static constexpr std::uint32_t kFullWeight = 64;  ///< a block's weight when its beams tell all they can

  /// Beams of weight zero are left out. At most about `most_beams` are kept, evenly spread over the scan.
  BeamBlocks(const ScanPoints& points, const LikelihoodField& field, std::size_t most_beams = 4096);

  /// Bits after the point of x and y: as many, up to 5, as the farthest beam leaves room for.
  [[nodiscard]] int fraction_bits() const { return fraction_bits_; }
  [[nodiscard]] std::size_t beams() const { return beams_; }
  [[nodiscard]] std::size_t blocks() const { return weight_.size(); }
  [[nodiscard]] std::span<const std::int16_t> x() const { return x_; }  ///< padded to whole blocks
  [[nodiscard]] std::span<const std::int16_t> y() const { return y_; }
  [[nodiscard]] std::span<const std::uint32_t> weight() const { return weight_; }  ///< one a block
  /// Sum of all beams' weights, one for a beam that tells all it can.
  [[nodiscard]] double total_weight() const { return total_weight_; }

 private:
  int fraction_bits_ = 5;
  std::size_t beams_ = 0;
  double total_weight_ = 0.0;
  std::vector<std::int16_t> x_;
  std::vector<std::int16_t> y_;
  std::vector<std::uint32_t> weight_;
};

/// For each particle the weighted sum of the field's counts under all beams; `sums` has one entry a particle.
/// Vectorised with run-time dispatch, in integers: the same on every processor, bit for bit.
void sum_counts(const Particles& particles, const BeamBlocks& beams, const LikelihoodField& field,
                std::span<std::uint32_t> sums);
/// The same, one beam after the other: the oracle.
void sum_counts_scalar(const Particles& particles, const BeamBlocks& beams, const LikelihoodField& field,
                       std::span<std::uint32_t> sums);

/// Log-likelihood of one summed count, tempered to the model's effective number of beams.
[[nodiscard]] double log_likelihood_per_count(const BeamBlocks& beams, const LikelihoodField& field);

}  // namespace madori::localization
