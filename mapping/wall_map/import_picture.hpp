#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/drawing/pixel_segment.hpp"
#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// A line of the Map frame as it lies on a drawing of this height and scale.
[[nodiscard]] PixelSegment on_drawing(const Segment2<Map>& line, int height_px, double m_per_px);

/// import.png: the drawing pale, walls bold, rejected lines thin in another colour, a scale bar and a legend;
/// lines the stronger the more probable they are walls (`probabilities` one a wall; none: all are certain).
/// At most 2400 pixels wide. PNG bytes.
[[nodiscard]] std::vector<std::uint8_t> import_picture(const GrayImage& drawing,
                                                       std::span<const PixelSegment> walls,
                                                       std::span<const RejectedSegment> rejected,
                                                       std::optional<double> m_per_px,
                                                       std::span<const double> probabilities = {});

}  // namespace madori::mapping
