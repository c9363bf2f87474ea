#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// How many pixels of a plane have each of its levels.
using ToneCounts = std::array<std::size_t, 256>;

[[nodiscard]] ToneCounts tone_counts(std::span<const std::uint8_t> plane);

/// The level that most pixels have.
[[nodiscard]] int commonest_tone(const ToneCounts& counts);

/// The greys that a drawing uses, and whether its ground is the dark one of them.
struct Tones {
  double darkest = 0, brightest = 255;
  bool dark_ground = false;
};

/// The ground is the commonest grey. It is dark where most steps from pixel to pixel lead to brighter greys.
/// Throws Error where the drawing is noise.
[[nodiscard]] Tones tones_of(const GrayImage& image);

/// For each grey of the drawing one between black and white, the ground on the bright side: a CAD screen, a
/// blueprint and a faint scan are the same drawing as one in black on white.
[[nodiscard]] std::array<std::uint8_t, 256> spread(const Tones& tones);

}  // namespace madori::mapping
