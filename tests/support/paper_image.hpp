#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "mapping/picture/gray_image.hpp"

namespace madori::test {

/// A sheet of one grey to draw on.
inline mapping::GrayImage paper(int width_px, int height_px, int level = 255) {
  return {width_px, height_px,
          std::vector<std::uint8_t>(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px),
                                    static_cast<std::uint8_t>(level)),
          0};
}

/// Its pixels for OpenCV's drawing functions.
inline cv::Mat canvas(mapping::GrayImage& image) {
  return {image.height_px, image.width_px, CV_8UC1, image.pixels.data()};
}

}  // namespace madori::test
