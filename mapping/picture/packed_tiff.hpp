#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "mapping/picture/image_header.hpp"

namespace madori::mapping {

/// Whether a TIFF has samples that OpenCV does not read (2 or 4 bits) or reads without their alpha (grey with
/// alpha).
[[nodiscard]] bool is_packed_tiff(const ImageHeader& header);

/// Such a TIFF's first page as 8-bit BGRA, read by GDAL, its orientation applied (TIFF 6.0 sections 4, 5 and
/// 18). Empty where it is damaged.
[[nodiscard]] cv::Mat decode_packed_tiff(const std::vector<std::uint8_t>& bytes, const ImageHeader& header);

}  // namespace madori::mapping
