#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// A picture's greys at a smaller size: each becomes what `table` says, then the mean of the area that a
/// pixel of the result covers. To the last bit what OpenCV's LUT and resize with INTER_AREA give, in less
/// than half of their time: no row is summed twice, and the picture is not copied for the table.
[[nodiscard]] std::vector<std::uint8_t> reduced(const GrayImage& image,
                                                const std::array<std::uint8_t, 256>& table, int width_px,
                                                int height_px);

}  // namespace madori::mapping
