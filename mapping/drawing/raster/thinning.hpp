#pragma once

#include "mapping/drawing/gray_image.hpp"

namespace madori::mapping {

/// Thins ink (255) in place to 8-connected lines one pixel wide (T. Zhang, C. Suen, CACM 27, 1984, with the
/// two-pixel-diagonal rule of Z. Guo, R. Hall, CACM 32, 1989). The work follows the ink, not the picture.
/// The outermost pixels of the picture become paper; what is left gets `value`.
void thin(GrayImage& ink, std::uint8_t value = 255);

}  // namespace madori::mapping
