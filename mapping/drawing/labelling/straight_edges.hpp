#pragma once

#include <vector>

#include "mapping/drawing/pixel_segment.hpp"
#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// Every straight edge between a darker and a brighter side, pixels of the picture: the line segment detector
/// of R. Grompone von Gioi, J. Jakubowicz, J.-M. Morel, G. Randall (IPOL 2012), to the step that OpenCV calls
/// LSD_REFINE_STD. OpenCV's sorts and keeps every pixel; here only those where the grey changes are kept: a
/// drawing is mostly paper. The same picture gives the same edges.
[[nodiscard]] std::vector<PixelSegment> straight_edges(const GrayImage& picture);

}  // namespace madori::mapping
