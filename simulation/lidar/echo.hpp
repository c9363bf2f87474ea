#pragma once

#include "simulation/lidar/beam_spot.hpp"
#include "simulation/lidar/range_bias.hpp"
#include "simulation/random.hpp"

namespace madori::simulation {

struct EchoOptions {
  float noise_m = 0.0F;
  double dropout = 0.0;
  double rain = 0.0;  ///< share of the beams that end somewhere on their way
  float range_min_m = 0.1F;
  float range_max_m = 100.0F;
};

/// What comes back of one beam; kNothing where nothing does.
struct Echo {
  float range_m = Hit::kNothing;
  Material material = Material::Wall;
};
struct Echoes {
  Echo first;
  Echo strongest;
  Echo last;

  /// What a VLP-16 in dual return mode tells beside the last: the strongest, and where that is the last one,
  /// the second strongest, which lies before it.
  [[nodiscard]] const Echo& beside_last() const {
    return strongest.range_m == last.range_m ? first : strongest;
  }
};

/// Glass answers only a beam that is nearly square on it; the others go through, and one in twelve of those
/// is lost. Grazing beams (under 1.5 deg) and a random share come back empty; another share ends at nothing
/// at all before its target, equally often at all ranges. `angle_rad` is what the systematic error knows the
/// beam by. One draw of 64 bits a beam, and one where it rains.
[[nodiscard]] Echoes echoes_of(const SpotHits& hits, const EchoOptions& options, const RangeBias& bias,
                               float angle_rad, Random& random);

}  // namespace madori::simulation
