// Compiled once for each instruction set; Highway picks at run time. Gathers are no faster than scalar loads
// on the processors at hand, so the vectors only compute where to look.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "localization/particle_filter/sensor_kernel_simd.cpp"
#include "localization/particle_filter/sensor_kernel_simd.hpp"

#include "hwy/foreach_target.h"  // must stand before highway.h
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace madori::localization::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kBlock = 32;

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void block_offsets(const SensorKernelBeams& beams, const SensorKernelPlace& at, std::size_t first,
                              std::int32_t* HWY_RESTRICT offsets) {
  for (std::size_t k = 0; k < kBlock; ++k) offsets[k] = table_offset(beams, at, first + k);
}
#else
/// row * width + column, widened; StoreU'd in whatever order is cheapest.
template <class D, class V>
HWY_INLINE void store_offsets(D d, V row, V column, std::int16_t width, std::int32_t* HWY_RESTRICT offsets) {
  const hn::RepartitionToWide<D> wide;
#if HWY_ARCH_X86
  const auto width_and_one = hn::InterleaveLower(d, hn::Set(d, width), hn::Set(d, std::int16_t{1}));
  auto unused = hn::Zero(wide);
  const auto lower = hn::ReorderWidenMulAccumulate(wide, hn::InterleaveLower(d, row, column), width_and_one,
                                                   hn::Zero(wide), unused);
  const auto upper = hn::ReorderWidenMulAccumulate(wide, hn::InterleaveUpper(d, row, column), width_and_one,
                                                   hn::Zero(wide), unused);
#else
  const hn::Half<D> half;
  const auto factor = hn::Set(wide, width);
  const auto lower = hn::Add(hn::Mul(hn::PromoteTo(wide, hn::LowerHalf(half, row)), factor),
                             hn::PromoteTo(wide, hn::LowerHalf(half, column)));
  const auto upper = hn::Add(hn::Mul(hn::PromoteTo(wide, hn::UpperHalf(half, row)), factor),
                             hn::PromoteTo(wide, hn::UpperHalf(half, column)));
#endif
  hn::StoreU(lower, wide, offsets);
  hn::StoreU(upper, wide, offsets + hn::Lanes(wide));
}

/// Table offsets, seen from the particle's cell, of the 32 beams of one block; their order within it is lost.
HWY_INLINE void block_offsets(const SensorKernelBeams& beams, const SensorKernelPlace& at, std::size_t first,
                              std::int32_t* HWY_RESTRICT offsets) {
  const hn::CappedTag<std::int16_t, kBlock> d;
  const auto c = hn::Set(d, at.cos), s = hn::Set(d, at.sin);
  const auto x = hn::Set(d, at.x), y = hn::Set(d, at.y);
  const auto low_x = hn::Set(d, at.low_x), high_x = hn::Set(d, at.high_x);
  const auto low_y = hn::Set(d, at.low_y), high_y = hn::Set(d, at.high_y);
  for (std::size_t k = 0; k < kBlock; k += hn::Lanes(d)) {
    const auto bx = hn::LoadU(d, beams.x + first + k);
    const auto by = hn::LoadU(d, beams.y + first + k);
    const auto u = hn::Sub(hn::Add(x, hn::MulFixedPoint15(c, bx)), hn::MulFixedPoint15(s, by));
    const auto v = hn::Add(hn::Add(y, hn::MulFixedPoint15(s, bx)), hn::MulFixedPoint15(c, by));
    const auto column = hn::ShiftRightSame(hn::Min(hn::Max(u, low_x), high_x), beams.fraction_bits);
    const auto row = hn::ShiftRightSame(hn::Min(hn::Max(v, low_y), high_y), beams.fraction_bits);
    store_offsets(d, row, column, beams.width, offsets + k);
  }
}
#endif

HWY_INLINE std::uint32_t sum_block(const std::uint8_t* HWY_RESTRICT table,
                                   const std::int32_t* HWY_RESTRICT offsets) {
  std::uint32_t even = 0;
  std::uint32_t odd = 0;
  for (std::size_t k = 0; k < kBlock; k += 8) {
    even += table[offsets[k]];
    odd += table[offsets[k + 1]];
    even += table[offsets[k + 2]];
    odd += table[offsets[k + 3]];
    even += table[offsets[k + 4]];
    odd += table[offsets[k + 5]];
    even += table[offsets[k + 6]];
    odd += table[offsets[k + 7]];
  }
  return even + odd;
}

void sum_all(const SensorKernelBeams& beams, const SensorKernelPlace* places, std::size_t particles,
             std::uint32_t* HWY_RESTRICT sums) {
  HWY_ALIGN std::int32_t offsets[2][kBlock];  // a block is computed while the one before is looked up
  const std::size_t blocks = (beams.count + kBlock - 1) / kBlock;
  for (std::size_t p = 0; p < particles; ++p) {
    const SensorKernelPlace at = places[p];
    const std::uint8_t* HWY_RESTRICT table = beams.table + at.cell;
    std::uint32_t sum = 0;
    block_offsets(beams, at, 0, offsets[0]);
    for (std::size_t block = 0; block < blocks; ++block) {
      if (block + 1 < blocks) block_offsets(beams, at, (block + 1) * kBlock, offsets[(block + 1) & 1]);
      sum += beams.weight[block] * sum_block(table, offsets[block & 1]);
    }
    // The padding repeats the last beam: what it added is taken off again.
    const auto padding = static_cast<std::uint32_t>(blocks * kBlock - beams.count);
    const std::uint32_t repeated = table[table_offset(beams, at, beams.count - 1)];
    sums[p] = sum - beams.weight[blocks - 1] * padding * repeated;
  }
}

}  // namespace madori::localization::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace madori::localization {

HWY_EXPORT(sum_all);

void sum_counts_simd(const SensorKernelBeams& beams, const SensorKernelPlace* places, std::size_t particles,
                     std::uint32_t* sums) {
  HWY_DYNAMIC_DISPATCH(sum_all)(beams, places, particles, sums);
}

}  // namespace madori::localization
#endif
