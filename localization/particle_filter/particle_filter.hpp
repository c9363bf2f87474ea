#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <vector>

#include "localization/particle_filter/beam_path.hpp"
#include "localization/particle_filter/likelihood_field.hpp"
#include "localization/particle_filter/particles.hpp"
#include "localization/particle_filter/resampling.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

struct ParticleFilterOptions {
  std::size_t min_particles = 500;
  std::size_t max_particles = 20'000;
  double resample_below = 0.5;  ///< effective share of the particles
  KldOptions kld;
  std::size_t most_beams = 720;  ///< of a scan
  /// Nats for a beam through a wall, as a share of all beams times effective_beams; 0: not checked.
  double through_wall_nats = 0.0;
};

struct ParticleEstimate {
  Transform2<Map, Base> map_from_base;  ///< weighted mean; the yaw's is circular
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double effective_size = 0.0;
};

/// Monte Carlo localization (Fox, Burgard, Dellaert, Thrun 1999) with an adaptive number of particles. All
/// chance comes from the seed: the same calls give the same particles on every processor.
class ParticleFilter {
 public:
  ParticleFilter(const ParticleFilterOptions& options, std::uint64_t seed);

  /// `count` particles from N(pose, covariance); the covariance is of (x, y, yaw), Map frame.
  void start_at(const Transform2<Map, Base>& pose, const Eigen::Matrix3d& covariance, std::size_t count);
  /// Replaces the lightest particles, `share` of all, by draws from N(pose, covariance) with that share of
  /// the weight.
  void inject(const Transform2<Map, Base>& pose, const Eigen::Matrix3d& covariance, double share);

  /// Each particle moves by a draw from N(moved, covariance); both are seen from the vehicle before the step.
  void predict(const Transform2<Base, Base>& moved, const Eigen::Matrix3d& covariance);
  /// Weighs the particles by a scan. With `walls` (and through_wall_nats) also by the beams that pass through
  /// them. Returns the mean log-likelihood over clutter, tempered: near zero when no particle explains the
  /// scan.
  double correct(const ScanPoints& points, const LikelihoodField& field,
                 const mapping::DistanceField* walls = nullptr);
  /// Resamples to the KLD number when the effective size has fallen; true when it did.
  bool resample_if_needed();

  [[nodiscard]] const Particles& particles() const { return particles_; }
  [[nodiscard]] ParticleEstimate estimate() const;

 private:
  void draw(const Transform2<Map, Base>& pose, const Eigen::Matrix3d& covariance, std::size_t first,
            std::size_t count);
  double weigh();

  ParticleFilterOptions options_;
  std::mt19937_64 random_;
  Particles particles_;
  Particles spare_;
  BinCounter bins_;
  std::vector<std::uint32_t> sums_;
  std::vector<float> log_weight_;
};

}  // namespace madori::localization
