#pragma once

#include <cstdint>

#include "simulation/random.hpp"
#include "simulation/world/ray_caster.hpp"

namespace madori::simulation {

struct EchoOptions {
  float noise_m = 0.0F;
  double dropout = 0.0;
  float range_min_m = 0.1F;
  float range_max_m = 100.0F;
};

/// What comes back of one beam; kNothing where nothing does.
struct Echo {
  float range_m = Hit::kNothing;
  Material material = Material::Wall;
};
struct Echoes {
  Echo strongest;
  Echo last;
};

/// Glass answers only a beam that is nearly square on it; the others go through, and one in twelve of those
/// is lost. Grazing beams (under 1.5 deg) and a random share come back empty. One draw of 64 bits a beam.
[[nodiscard]] Echoes echoes_of(const Hit& hit, const EchoOptions& options, std::uint64_t bits);

}  // namespace madori::simulation
