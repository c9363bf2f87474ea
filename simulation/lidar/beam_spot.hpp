#pragma once

#include <span>
#include <vector>

#include "simulation/world/ray_caster.hpp"

namespace madori::simulation {

/// A beam is no line: its cross-section, sampled by rays of equal energy.
class BeamSpot {
 public:
  /// Across the beam, in units of its radius.
  struct Offset {
    double left = 0.0, up = 0.0;
  };

  /// One ray in the middle.
  BeamSpot() : rays_{Offset{}} {}
  /// Two rays opposite each other, or five: the middle, and four around it that lie at five different places
  /// from left to right and from bottom to top. A beam without width gets one ray whatever is asked.
  BeamSpot(double beam_m, double spread_rad, std::size_t rays);

  [[nodiscard]] const std::vector<Offset>& rays() const { return rays_; }
  [[nodiscard]] double beam_m() const { return beam_m_; }
  [[nodiscard]] double spread_rad() const { return spread_rad_; }
  [[nodiscard]] double diameter_m(double range_m) const { return beam_m_ + spread_rad_ * range_m; }

 private:
  double beam_m_ = 0.0, spread_rad_ = 0.0;
  std::vector<Offset> rays_;
};

/// Surfaces nearer together than this come back as one echo: a pulse of 6 ns (VLP-16 manual) is so long.
inline constexpr float kPulseM = 0.9F;
/// A surface that takes a smaller share of the beam than this is not noticed.
inline constexpr float kLeastShare = 0.25F;

/// What a whole beam meets.
struct SpotHits {
  Hit first;            ///< the nearest that is noticed
  Hit last;             ///< the farthest
  Hit strongest;        ///< the one that takes most of the beam
  bool parted = false;  ///< whether these are not one and the same
};

/// The echoes of the rays of a spot. A surface that the spot lies
/// on slantwise gives the mean; across an edge with less than kPulseM between both sides the ranges melt into
/// one between them (mixed pixels); with more there are two echoes. How the edge divides the spot between two
/// rays is drawn: `share` in [0, 1).
[[nodiscard]] SpotHits meet(std::span<const Hit> rays, const BeamSpot& spot, float share);

}  // namespace madori::simulation
