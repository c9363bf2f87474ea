// PNG files are written by OpenCV here, with every filter, and read by the quick decoder.
#include "mapping/picture/grey_png.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace madori::mapping {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A ramp, strokes and noise, so that an adaptive encoder uses all five filters.
cv::Mat scan(int width, int height) {
  cv::Mat picture(height, width, CV_8UC1);
  cv::RNG random(7);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      picture.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(u * v / 40 + (v / 16 % 2 == 0 ? u : 0));
  cv::Mat noise(height / 2, width, CV_8UC1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  noise.copyTo(picture.rowRange(0, height / 2));
  cv::line(picture, {5, height / 2}, {width - 5, height - 5}, 0, 4, cv::LINE_AA);
  return picture;
}

Bytes pixels_of(const cv::Mat& picture) {
  return {picture.datastart, picture.dataend};
}

Bytes encoded(const cv::Mat& picture, int level) {
  Bytes bytes;
  cv::imencode(".png", picture, bytes,
               level < 0 ? std::vector<int>{} : std::vector<int>{cv::IMWRITE_PNG_COMPRESSION, level});
  return bytes;
}

TEST(GreyPng, PixelsAreThoseWritten) {
  for (const cv::Size size : {cv::Size(201, 160), cv::Size(33, 300), cv::Size(2000, 40)})
    for (const int level : {-1, 0, 1, 6, 9}) {
      const cv::Mat picture = scan(size.width, size.height);
      const auto pixels = decode_grey_png(encoded(picture, level));
      ASSERT_TRUE(pixels) << level;
      EXPECT_EQ(*pixels, pixels_of(picture)) << level;
    }
}

TEST(GreyPng, OtherKindsAreLeftToOthers) {
  const cv::Mat grey = scan(60, 50);
  cv::Mat colour, deep;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  grey.convertTo(deep, CV_16U, 257);
  EXPECT_FALSE(decode_grey_png(encoded(colour, -1)));
  EXPECT_FALSE(decode_grey_png(encoded(deep, -1)));
  EXPECT_FALSE(decode_grey_png({}));
}

TEST(GreyPng, AnyCutAndAnyChangedByteIsSeen) {
  const Bytes whole = encoded(scan(40, 30), 6);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(decode_grey_png({whole.data(), size})) << size;
  for (std::size_t at = 8; at < whole.size(); ++at) {  // the signature is the header reader's matter
    Bytes changed = whole;
    changed[at] ^= 0x11U;
    EXPECT_FALSE(decode_grey_png(changed)) << at;
  }
}

}  // namespace
}  // namespace madori::mapping
