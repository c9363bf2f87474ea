// Compiled once for each instruction set; Highway picks at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "localization/global/circular_match.cpp"
#include "localization/global/circular_match.hpp"

#include <cstring>

#include "hwy/foreach_target.h"  // must stand before highway.h
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace madori::localization::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kSections = 64;
constexpr std::uint8_t kUnseen = 255;

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE std::uint16_t turned_cost(const std::uint8_t* scan, const std::uint8_t* /*seen*/,
                                     const std::uint8_t* view, std::uint8_t most) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < kSections; ++i) {
    const unsigned d = scan[i] > view[i] ? scan[i] - view[i] : view[i] - scan[i];
    if (scan[i] != kUnseen) sum += d < most ? d : most;
  }
  return static_cast<std::uint16_t>(sum);
}
#else
HWY_INLINE std::uint16_t turned_cost(const std::uint8_t* HWY_RESTRICT scan,
                                     const std::uint8_t* HWY_RESTRICT seen,
                                     const std::uint8_t* HWY_RESTRICT view, std::uint8_t most) {
  const hn::CappedTag<std::uint8_t, kSections> d;
  const hn::Repartition<std::uint64_t, decltype(d)> d64;
  const auto limit = hn::Set(d, most);
  auto sum = hn::Zero(d64);
  for (std::size_t k = 0; k < kSections; k += hn::Lanes(d)) {
    const auto a = hn::Load(d, scan + k);
    const auto b = hn::LoadU(d, view + k);
    const auto difference = hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a));
    sum = hn::Add(sum, hn::SumsOf8(hn::And(hn::Min(difference, limit), hn::Load(d, seen + k))));
  }
  return static_cast<std::uint16_t>(hn::GetLane(hn::SumOfLanes(d64, sum)));
}
#endif

void match_all(const std::uint8_t* scan, const std::uint8_t* views, std::size_t places, std::uint8_t most,
               std::uint16_t* HWY_RESTRICT costs) {
  HWY_ALIGN std::uint8_t aligned[kSections];
  HWY_ALIGN std::uint8_t seen[kSections];
  HWY_ALIGN std::uint8_t twice[2 * kSections];  // so that every turn is one stretch of memory
  for (std::size_t i = 0; i < kSections; ++i) {
    aligned[i] = scan[i];
    seen[i] = scan[i] == kUnseen ? 0 : 0xFF;
  }
  for (std::size_t p = 0; p < places; ++p) {
    std::memcpy(twice, views + p * kSections, kSections);
    std::memcpy(twice + kSections, views + p * kSections, kSections);
    for (std::size_t turn = 0; turn < kSections; ++turn)
      costs[p * kSections + turn] = turned_cost(aligned, seen, twice + turn, most);
  }
}

}  // namespace madori::localization::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace madori::localization {

HWY_EXPORT(match_all);

void circular_match(const std::uint8_t* scan, const std::uint8_t* views, std::size_t places,
                    std::uint8_t most, std::uint16_t* costs) {
  HWY_DYNAMIC_DISPATCH(match_all)(scan, views, places, most, costs);
}

}  // namespace madori::localization
#endif
