#include "simulation/lidar/range_bias.hpp"

#include <cmath>
#include <numbers>

namespace madori::simulation {
namespace {

// How much of the whole each part is, at most.
constexpr double kOffset = 0.45, kByRange = 0.3, kByAngle = 0.1, kByMaterial = 0.15;
constexpr double kShortestWaveM = 6.0, kLongestWaveM = 25.0;

constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;

/// Two parabolas: as good as a sine, and 300,000 beams a second ask for it.
float wave(float waves) {
  const float part = waves - std::floor(waves);
  return part < 0.5F ? 8.0F * part * (1.0F - 2.0F * part) : -8.0F * (part - 0.5F) * (2.0F - 2.0F * part);
}

}  // namespace

RangeBias::RangeBias(double most_m, Random& random) {
  offset_m_ = static_cast<float>(kOffset * most_m * random.uniform(-1.0, 1.0));
  by_range_m_ = static_cast<float>(kByRange * most_m);
  by_angle_m_ = static_cast<float>(kByAngle * most_m);
  range_phase_ = static_cast<float>(random.uniform());
  waves_a_metre_ = static_cast<float>(1.0 / random.uniform(kShortestWaveM, kLongestWaveM));
  angle_phase_ = static_cast<float>(random.uniform());
  for (float& part : by_material_m_)
    part = static_cast<float>(kByMaterial * most_m * random.uniform(-1.0, 1.0));
}

float RangeBias::at(float range_m, float angle_rad, Material material) const {
  return offset_m_ + by_range_m_ * wave(waves_a_metre_ * range_m + range_phase_) +
         by_angle_m_ * wave(angle_rad / kTurn + angle_phase_) +
         by_material_m_[static_cast<std::size_t>(material)];
}

}  // namespace madori::simulation
