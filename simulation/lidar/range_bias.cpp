#include "simulation/lidar/range_bias.hpp"

#include <cmath>
#include <numbers>

namespace madori::simulation {
namespace {

// How much of the whole each part is, at most.
constexpr double kOffset = 0.45, kByRange = 0.3, kByAngle = 0.1, kByMaterial = 0.15;
constexpr double kShortestWaveM = 6.0, kLongestWaveM = 25.0;

}  // namespace

RangeBias::RangeBias(double most_m, Random& random) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  offset_m_ = static_cast<float>(kOffset * most_m * random.uniform(-1.0, 1.0));
  by_range_m_ = static_cast<float>(kByRange * most_m);
  by_angle_m_ = static_cast<float>(kByAngle * most_m);
  range_phase_ = static_cast<float>(random.uniform(0.0, kTurn));
  range_rate_ = static_cast<float>(kTurn / random.uniform(kShortestWaveM, kLongestWaveM));
  angle_phase_ = static_cast<float>(random.uniform(0.0, kTurn));
  for (float& part : by_material_m_)
    part = static_cast<float>(kByMaterial * most_m * random.uniform(-1.0, 1.0));
}

float RangeBias::at(float range_m, float angle_rad, Material material) const {
  return offset_m_ + by_range_m_ * std::sin(range_rate_ * range_m + range_phase_) +
         by_angle_m_ * std::sin(angle_rad + angle_phase_) +
         by_material_m_[static_cast<std::size_t>(material)];
}

}  // namespace madori::simulation
