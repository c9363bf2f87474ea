#pragma once

#include "simulation/random.hpp"
#include "simulation/world/mesh.hpp"

namespace madori::simulation {

/// The systematic part of a range's error, of one device (or one laser of it): an offset, and parts that
/// change slowly with the range, with the angle of the beam and with what it hits. Never beyond the most that
/// it is made with; each part has a share of it that is the same for all devices, its sign, phase and wave
/// length are the device's own.
class RangeBias {
 public:
  RangeBias() = default;
  RangeBias(double most_m, Random& random);

  [[nodiscard]] float at(float range_m, float angle_rad, Material material) const;

 private:
  float offset_m_ = 0.0F;
  float by_range_m_ = 0.0F, by_angle_m_ = 0.0F;
  float range_phase_ = 0.0F, waves_a_metre_ = 0.0F, angle_phase_ = 0.0F;  ///< in whole waves
  std::array<float, kMaterials> by_material_m_{};
};

}  // namespace madori::simulation
