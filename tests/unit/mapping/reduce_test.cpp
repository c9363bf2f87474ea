// A picture reduced beside OpenCV's LUT and resize.
#include "mapping/picture/reduce.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <random>

#include "mapping/picture/cv_view.hpp"

namespace madori::mapping {
namespace {

TEST(Reduce, IsOpenCvsAreaToTheLastBit) {
  std::mt19937 random(7);
  GrayImage image{.width_px = 613, .height_px = 401, .pixels = std::vector<std::uint8_t>(613 * 401)};
  for (auto& pixel : image.pixels) pixel = static_cast<std::uint8_t>(random() % 256);
  std::array<std::uint8_t, 256> table{};
  for (std::size_t grey = 0; grey < 256; ++grey) table[grey] = static_cast<std::uint8_t>(255 - grey);
  cv::Mat levels, expected;
  cv::LUT(cv_view(image), table, levels);
  for (const cv::Size size : {cv::Size(612, 400), cv::Size(577, 379), cv::Size(467, 305), cv::Size(306, 200),
                              cv::Size(209, 137), cv::Size(613, 137), cv::Size(100, 401), cv::Size(613, 1),
                              cv::Size(31, 20), cv::Size(1, 1), cv::Size(613, 401)}) {
    cv::resize(levels, expected, size, 0, 0, cv::INTER_AREA);
    const auto out = reduced(image, table, size.width, size.height);
    EXPECT_TRUE(std::equal(out.begin(), out.end(), expected.datastart, expected.dataend)) << size;
  }
}

}  // namespace
}  // namespace madori::mapping
