#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace madori::mapping {

using PaletteColour = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// A PNG of one byte a pixel, each an index into at most 256 colours; row by row from the top. A third of the
/// bytes of a colour picture, and packed several times as fast.
/// Precondition: width * height indices, each below the number of colours.
[[nodiscard]] std::vector<std::uint8_t> palette_png(int width, int height,
                                                    std::span<const std::uint8_t> indices,
                                                    std::span<const PaletteColour> colours);

}  // namespace madori::mapping
