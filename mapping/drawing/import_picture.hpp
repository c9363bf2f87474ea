#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mapping/drawing/gray_image.hpp"
#include "mapping/drawing/pixel_segment.hpp"

namespace madori::mapping {

/// import.png: the drawing pale, walls bold, rejected lines thin in another colour, a scale bar and a legend.
/// At most `widest_px` wide. PNG bytes.
[[nodiscard]] std::vector<std::uint8_t> import_picture(const GrayImage& drawing,
                                                       std::span<const PixelSegment> walls,
                                                       std::span<const RejectedSegment> rejected,
                                                       std::optional<double> m_per_px, int widest_px = 2400);

}  // namespace madori::mapping
