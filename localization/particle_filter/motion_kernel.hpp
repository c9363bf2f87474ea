#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace madori::localization {

/// One motion step as every particle samples it: moved ~ N(mean, lower * lower^T), seen from the particle.
struct MotionStep {
  std::array<float, 3> mean{};   ///< x_m, y_m, yaw_rad
  std::array<float, 6> lower{};  ///< of the Cholesky factor: xx, yx, yy, tx, ty, tt
  std::uint32_t key1 = 0;        ///< random, new for each step
  std::uint32_t key2 = 0;
};

/// Moves `count` particles by the step; particle i draws the i-th triple of the random stream that the keys
/// name. Vectorised with run-time dispatch, without fused arithmetic: the same on every processor, bit for
/// bit.
void move_particles(const MotionStep& step, float* x_m, float* y_m, float* yaw_rad, std::size_t count);
/// The same, one after the other: the oracle.
void move_particles_scalar(const MotionStep& step, float* x_m, float* y_m, float* yaw_rad, std::size_t count);

}  // namespace madori::localization
