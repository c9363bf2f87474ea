#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace madori::localization {

/// The beams and the table as the kernels read them; coordinates in cells with `fraction_bits` after the
/// point.
struct SensorKernelBeams {
  const std::int16_t* x = nullptr;
  const std::int16_t* y = nullptr;
  const std::uint32_t* weight = nullptr;  ///< one for each 32 beams
  std::size_t count = 0;
  int fraction_bits = 0;
  std::int16_t width = 0;  ///< of the table
  const std::uint8_t* table = nullptr;
};

/// One particle: its cell, the place within the cell, the turn in Q15, and the table's bounds seen from the
/// cell.
struct SensorKernelPlace {
  std::int64_t cell = 0;
  std::int16_t x = 0, y = 0, cos = 0, sin = 0;
  std::int16_t low_x = 0, low_y = 0, high_x = 0, high_y = 0;
};

[[nodiscard]] inline std::int32_t multiply_q15(std::int16_t a, std::int16_t b) {
  return (std::int32_t{a} * b + 0x4000) >> 15;
}

/// Where beam `i` looks up, seen from the particle's cell: what the vectors compute for many beams at once.
[[nodiscard]] inline std::int32_t table_offset(const SensorKernelBeams& beams, const SensorKernelPlace& at,
                                               std::size_t i) {
  const std::int16_t bx = beams.x[i];
  const std::int16_t by = beams.y[i];
  const std::int32_t u = at.x + multiply_q15(at.cos, bx) - multiply_q15(at.sin, by);
  const std::int32_t v = at.y + multiply_q15(at.sin, bx) + multiply_q15(at.cos, by);
  const std::int32_t column = std::clamp<std::int32_t>(u, at.low_x, at.high_x) >> beams.fraction_bits;
  const std::int32_t row = std::clamp<std::int32_t>(v, at.low_y, at.high_y) >> beams.fraction_bits;
  return row * beams.width + column;
}

void sum_counts_simd(const SensorKernelBeams& beams, const SensorKernelPlace* places, std::size_t particles,
                     std::uint32_t* sums);

}  // namespace madori::localization
