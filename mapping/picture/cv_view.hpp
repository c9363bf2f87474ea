#pragma once
// Private to the raster stages: OpenCV sees the pixels of a GrayImage in place.

#include <opencv2/core.hpp>

#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

inline cv::Mat cv_view(GrayImage& image) {
  return {image.height_px, image.width_px, CV_8UC1, image.pixels.data()};
}

/// OpenCV has no constant picture header; the callers only read.
inline cv::Mat cv_view(const GrayImage& image) {
  return {image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data())};
}

}  // namespace madori::mapping
