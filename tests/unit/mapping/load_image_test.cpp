// Pictures are written by OpenCV here and read by the importer.
#include "mapping/picture/load_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/result.hpp"
#include "mapping/picture/image_header.hpp"
#include "mapping/picture/quiet_stderr.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

using ::testing::HasSubstr;

class LoadImage : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const cv::Mat& picture) {
    const auto file = folder_.path() / name;
    cv::imwrite(file.string(), picture);
    return file;
  }
  std::filesystem::path write_text(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
    return folder_.path() / name;
  }
  static std::string reason(const std::filesystem::path& file) {
    try {
      static_cast<void>(load_image(file));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
};

/// Two threads read pictures at once, and the one that began first ends first.
TEST(QuietStderr, TheLastOneGivesItBack) {
  struct stat before {
  }, during{}, after{};
  ASSERT_EQ(::fstat(STDERR_FILENO, &before), 0);
  auto first = std::make_unique<QuietStderr>();
  auto second = std::make_unique<QuietStderr>();
  first.reset();
  ASSERT_EQ(::fstat(STDERR_FILENO, &during), 0);
  second.reset();
  ASSERT_EQ(::fstat(STDERR_FILENO, &after), 0);
  EXPECT_NE(during.st_ino, before.st_ino);
  EXPECT_EQ(after.st_ino, before.st_ino);
  EXPECT_EQ(after.st_dev, before.st_dev);
}

TEST_F(LoadImage, TransparentBecomesWhite) {
  cv::Mat picture(2, 3, CV_8UC4, cv::Scalar(0, 0, 0, 0));
  picture.at<cv::Vec4b>(1, 2) = {0, 0, 0, 255};
  picture.at<cv::Vec4b>(0, 1) = {0, 0, 0, 128};
  const GrayImage image = load_image(write("alpha.png", picture));
  ASSERT_EQ(image.width_px, 3);
  ASSERT_EQ(image.height_px, 2);
  EXPECT_EQ(image.at(0, 0), 255);
  EXPECT_EQ(image.at(2, 1), 0);
  EXPECT_NEAR(image.at(1, 0), 127, 1);
}

TEST_F(LoadImage, EveryDepthAndFormat) {
  cv::Mat picture(4, 4, CV_8UC1, cv::Scalar(200));
  picture.at<std::uint8_t>(2, 1) = 40;
  for (const char* name : {"grey.png", "grey.tiff", "grey.bmp"}) {
    const GrayImage image = load_image(write(name, picture));
    EXPECT_EQ(image.at(1, 2), 40) << name;
    EXPECT_EQ(image.at(2, 1), 200) << name;
  }
  cv::Mat deep;
  picture.convertTo(deep, CV_16U, 257);
  EXPECT_EQ(load_image(write("deep.png", deep)).at(1, 2), 40);
  EXPECT_EQ(load_image(write("deep.tiff", deep)).at(1, 2), 40);
  std::vector<int> one_bit{cv::IMWRITE_PNG_BILEVEL, 1};
  cv::Mat bilevel = picture > 100;
  cv::imwrite((folder_.path() / "bit.png").string(), bilevel, one_bit);
  EXPECT_EQ(load_image(folder_.path() / "bit.png").at(1, 2), 0);
  EXPECT_EQ(load_image(folder_.path() / "bit.png").at(0, 0), 255);
}

/// A TIFF of 4 x 2 pixels, uncompressed, with these further SHORT tags.
std::string tiff_of(int bits, const std::map<int, std::vector<int>>& tags, const std::string& data) {
  std::map<int, std::vector<int>> all{{256, {4}}, {257, {2}}, {258, {bits}},
                                      {259, {1}}, {277, {1}}, {278, {2}}};
  for (const auto& [tag, values] : tags) all[tag] = values;
  const auto number = [](std::size_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>((value >> (8 * i)) & 0xFFU);
    return text;
  };
  const std::size_t entries = all.size() + 2, after = 8 + 2 + 12 * entries + 4;
  std::string beyond = data, directory = number(entries, 2);
  all[273] = {static_cast<int>(after)}, all[279] = {static_cast<int>(data.size())};
  for (const auto& [tag, values] : all) {
    std::string packed;
    for (const int value : values) packed += number(static_cast<std::size_t>(value), 2);
    directory += number(static_cast<std::size_t>(tag), 2) + number(3, 2) + number(values.size(), 4);
    if (packed.size() > 4) {
      directory += number(after + beyond.size(), 4);
      beyond += packed;
    } else {
      packed.resize(4);
      directory += packed;
    }
  }
  return std::string("II*\0", 4) + number(8, 4) + directory + number(0, 4) + beyond;
}

/// Rows of a picture, for comparison.
std::vector<int> greys(const GrayImage& image) {
  std::vector<int> all;
  for (int v = 0; v < image.height_px; ++v)
    for (int u = 0; u < image.width_px; ++u) all.push_back(image.at(u, v));
  return all;
}

TEST_F(LoadImage, TiffsOfTwoAndFourBitAndGreyWithAlpha) {
  using Greys = std::vector<int>;
  const std::string nibbles("\xF0\xF5\xFF\xFF", 4);
  EXPECT_EQ(greys(load_image(write_text("g4.tif", tiff_of(4, {{262, {1}}}, nibbles)))),
            (Greys{255, 0, 255, 85, 255, 255, 255, 255}));
  EXPECT_EQ(greys(load_image(write_text("n4.tif", tiff_of(4, {{262, {0}}}, nibbles)))),
            (Greys{0, 255, 0, 170, 0, 0, 0, 0}));
  EXPECT_EQ(greys(load_image(write_text("g2.tif", tiff_of(2, {{262, {1}}}, "\xF1\xFF")))),
            (Greys{255, 255, 0, 85, 255, 255, 255, 255}));
  std::vector<int> palette(48, 65'535);
  for (const int black : {5, 21, 37}) palette[static_cast<std::size_t>(black)] = 0;
  EXPECT_EQ(greys(load_image(write_text("p4.tif", tiff_of(4, {{262, {3}}, {320, palette}}, nibbles)))),
            (Greys{255, 255, 255, 0, 255, 255, 255, 255}));
  const GrayImage turned = load_image(write_text("t4.tif", tiff_of(4, {{262, {1}}, {274, {6}}}, nibbles)));
  ASSERT_EQ(turned.width_px, 2);
  EXPECT_EQ(greys(turned), (Greys{255, 255, 255, 0, 255, 255, 255, 85}));
  const std::string black_line("\0\0\0\xFF\0\xFF\0\0\0\0\0\0\0\0\0\x80", 16);
  EXPECT_EQ(greys(load_image(write_text(
                "ga.tif", tiff_of(8, {{258, {8, 8}}, {262, {1}}, {277, {2}}, {338, {2}}}, black_line)))),
            (Greys{255, 0, 0, 255, 255, 255, 255, 127}));
  EXPECT_NE(reason(write_text("no_bits.tif", tiff_of(0, {{262, {1}}, {277, {2}}}, black_line))), "");
  EXPECT_THAT(reason(write_text("cut.tif", tiff_of(4, {{262, {1}}}, nibbles).substr(0, 90))),
              HasSubstr("cut off"));
}

/// A square drawn on a sheet that was faxed at 204 x 98 dots per inch, and at 204 x 196.
TEST_F(LoadImage, AFaxIsNoLongerSquashed) {
  for (const int dpi_v : {98, 196}) {
    const int rows = 408 * dpi_v / 204;
    cv::Mat fax(rows, 408, CV_8UC1, cv::Scalar(255));
    cv::rectangle(fax, {102, rows / 4}, {305, rows * 3 / 4 - 1}, 0, cv::FILLED);
    const auto file = folder_.path() / "fax.tif";
    cv::imwrite(file.string(), fax,
                {cv::IMWRITE_TIFF_RESUNIT, 2, cv::IMWRITE_TIFF_XDPI, 204, cv::IMWRITE_TIFF_YDPI, dpi_v});
    const GrayImage image = load_image(file);
    EXPECT_EQ(image.width_px, 408);
    EXPECT_EQ(image.height_px, 408) << dpi_v;
    EXPECT_EQ(image.dpi, 204.0);
    EXPECT_EQ(std::ranges::count_if(image.pixels, [](std::uint8_t value) { return value < 128; }), 204 * 204);
  }
}

TEST_F(LoadImage, BadInputIsNamedWithItsMend) {
  EXPECT_THAT(reason(folder_.path() / "absent.png"), HasSubstr("cannot be opened"));
  EXPECT_THAT(reason(folder_.path()), HasSubstr("is a folder"));
  EXPECT_THAT(reason(write_text("empty.png", "")), HasSubstr("is empty"));
  EXPECT_THAT(reason(write_text("text.png", "this is no picture at all")), HasSubstr("not an image"));
  const auto good = write("good.png", cv::Mat(300, 300, CV_8UC1, cv::Scalar(7)));
  std::filesystem::resize_file(good, std::filesystem::file_size(good) / 2);
  EXPECT_THAT(reason(good), HasSubstr("damaged or cut off"));
}

/// Decoders fill the missing half of a JPEG with grey, and say so on stderr only.
TEST_F(LoadImage, EveryFormatCutOffIsRefusedInSilence) {
  cv::Mat picture(400, 500, CV_8UC1, cv::Scalar(255));
  for (int i = 0; i < 400; i += 7) cv::line(picture, {0, i}, {499, 399 - i}, 0);
  for (const char* name : {"a.jpg", "b.png", "c.tiff", "d.bmp"}) {
    const auto file = write(name, picture);
    EXPECT_NO_THROW((void)load_image(file)) << name;
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
    testing::internal::CaptureStderr();
    EXPECT_THAT(reason(file), HasSubstr("cut off")) << name;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << name;
  }
}

TEST_F(LoadImage, AGigapixelIsRefusedBeforeItIsDecoded) {
  std::string header("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  header += std::string("\0\0\x80\0\0\0\x80\0\x01\0\0\0\0", 13);  // 32768 x 32768, one bit
  EXPECT_THAT(reason(write_text("huge.png", header)), HasSubstr("1074 megapixels"));
}

/// A head that promises so many pixels of 8 or 16 bits in colour (2), with alpha (6).
std::string png_head(std::uint16_t width_px, std::uint16_t height_px, int bits, int kind) {
  const auto two = [](std::uint16_t n) {
    return std::string{'\0', '\0', static_cast<char>(n >> 8U), static_cast<char>(n & 0xFFU)};
  };
  return std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) + two(width_px) + two(height_px) +
         std::string{
             static_cast<char>(bits), static_cast<char>(kind), '\0', '\0', '\0', '\0', '\0', '\0', '\0'};
}

TEST_F(LoadImage, TheDecodedSizeIsLimitedToo) {
  EXPECT_THAT(reason(write_text("deep.png", png_head(20000, 14900, 16, 6))), HasSubstr("2384 MB decoded"));
  EXPECT_THAT(reason(write_text("colour.png", png_head(10000, 6000, 8, 6))), HasSubstr("damaged"));
}

TEST_F(LoadImage, WhatIsNoRegularFileOrHugeIsNotRead) {
  EXPECT_THAT(reason("/dev/zero"), HasSubstr("no regular file"));
  const auto sparse = write_text("sparse.png", "");
  std::filesystem::resize_file(sparse, 3'000'000'000);
  EXPECT_THAT(reason(sparse), HasSubstr("has 3000000000 bytes"));
}

TEST(ImageHeader, AnAbsurdResolutionIsUnknown) {
  const auto dpi = [](const std::string& dots_per_metre) {
    std::string png = png_head(10, 10, 8, 2);
    png +=
        std::string("\0\0\0\x09pHYs", 8) + dots_per_metre + dots_per_metre + std::string("\x01\0\0\0\0", 5);
    return read_image_header({reinterpret_cast<const std::uint8_t*>(png.data()), png.size()})->dpi;
  };
  EXPECT_NEAR(dpi(std::string("\0\0\x2E\x23", 4)), 300.0, 0.1);
  EXPECT_EQ(dpi("\xFF\xFF\xFF\xFF"), 0.0);
  EXPECT_EQ(dpi(std::string("\0\0\0\x01", 4)), 0.0);
}

TEST(ImageHeader, TruncatedBytesAreNeverReadPastTheirEnd) {
  const std::vector<std::uint8_t> tiff{'I', 'I', 42, 0, 0xFF, 0xFF, 0xFF, 0x7F};
  const auto header = read_image_header(tiff);
  ASSERT_TRUE(header);
  EXPECT_EQ(header->width_px, 0);
  EXPECT_FALSE(read_image_header({}));
}

}  // namespace
}  // namespace madori::mapping
