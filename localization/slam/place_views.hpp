#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/transform2.hpp"
#include "localization/memory/surface_scan.hpp"

namespace madori::localization {

/// The view from a place: relative directional neighbours (RDN, Kis et al. 2021) in 64 sections, as the
/// logarithm of the distance, so that a metre counts for less the farther away it is. 255: nothing there.
using PlaceView = std::array<std::uint8_t, 64>;
inline constexpr std::uint8_t kNoView = 255;

/// From the origin of the scan's axes.
[[nodiscard]] PlaceView place_view(const SurfaceScan& surroundings);

struct ViewDifference {
  double difference = 1.0;  ///< 0 alike, 1 nothing in common
  int shift = 0;            ///< section i of the one is section i + shift of the other: the turn in sections
  [[nodiscard]] double turn_rad() const;
};

/// The best turn of `seen` against `old`: RDNM's comparison, capped differences, over the sections that both
/// have; a difference of 1 where these are fewer than half.
[[nodiscard]] ViewDifference compare_views(const PlaceView& seen, const PlaceView& old);

}  // namespace madori::localization
