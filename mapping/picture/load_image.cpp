#include "mapping/picture/load_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "core/input_file.hpp"
#include "core/result.hpp"
#include "mapping/picture/grey_png.hpp"
#include "mapping/picture/image_header.hpp"
#include "mapping/picture/packed_tiff.hpp"
#include "mapping/picture/quiet_stderr.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kMostFileBytes = 512'000'000;
constexpr auto kFormats = "give a PNG, JPEG, TIFF or BMP picture";

std::vector<std::uint8_t> read_bytes(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) throw Error(file.string(), "is a folder", "name the drawing inside it");
  require_readable(file, kMostFileBytes);
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const auto size = stream ? static_cast<std::streamoff>(stream.tellg()) : -1;
  if (size < 0) throw Error(file.string(), "cannot be read", "check its permissions");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes.data()), size);
  if (!stream) throw Error(file.string(), "cannot be read to its end", "check the disk");
  return bytes;
}

void expect_at_most(const fs::path& file, double amount, double most, const char* unit) {
  if (amount > most)
    throw Error(file.string(),
                "has " + std::to_string(std::llround(amount)) + unit + ", more than " +
                    std::to_string(std::llround(most)),
                "export it at a lower resolution (12 megapixels are plenty for a floor)");
}

/// How many times as long a pixel is as it is wide, or the other way round; 1 where it makes no difference.
double longest_pixel(const ImageHeader& header) {
  constexpr double kSquare = 1.005;  // no scale is better known
  const auto [less, more] = std::minmax(header.dpi, header.dpi_v);
  return more > kSquare * less ? more / less : 1.0;
}

/// A fax is coarser in one direction: that is enlarged until the pixels are square, as viewers do.
cv::Mat squared(const cv::Mat& picture, const ImageHeader& header) {
  const double longest = longest_pixel(header);
  if (longest == 1.0) return picture;
  const bool turned = picture.cols != header.width_px;  // by its EXIF orientation
  const bool wide = (header.dpi < header.dpi_v) != turned;
  cv::Mat even;
  cv::resize(picture, even, {}, wide ? longest : 1.0, wide ? 1.0 : longest, cv::INTER_LINEAR);
  return even;
}

ImageHeader checked_header(const fs::path& file, const std::vector<std::uint8_t>& bytes) {
  if (bytes.empty()) throw Error(file.string(), "is empty", kFormats);
  const auto header = read_image_header(bytes);
  if (!header) throw Error(file.string(), "is not an image that Madori reads", kFormats);
  if (header->width_px <= 0 || header->height_px <= 0)
    throw Error(file.string(), "has no pixels or is cut off", "export it again");
  const double megapixels = longest_pixel(*header) * static_cast<double>(header->width_px) *
                            static_cast<double>(header->height_px) / 1e6;
  expect_at_most(file, megapixels, kMaxImageMegapixels, " megapixels");
  const int bytes_per_px = is_packed_tiff(*header) ? 4 : header->bytes_per_px;
  expect_at_most(file, megapixels * bytes_per_px, kMaxDecodedMb, " MB decoded");
  return *header;
}

/// Whether the end-of-image marker follows the picture's data (ITU-T T.81 B.1.1.2; the data itself holds no
/// such marker, a thumbnail before it may). Decoders fill what is missing of a JPEG with grey.
bool ends_as_jpeg(const std::vector<std::uint8_t>& bytes) {
  constexpr std::array<std::uint8_t, 2> kScan{0xFF, 0xDA}, kEnd{0xFF, 0xD9};
  std::size_t at = 2;
  while (at + 4 <= bytes.size() && bytes[at] == kScan[0] && bytes[at + 1] != kScan[1])
    at += bytes[at + 1] == 0xFF ? 1 : 2 + (std::size_t{bytes[at + 2]} << 8U | bytes[at + 3]);
  const auto data = bytes.begin() + static_cast<std::ptrdiff_t>(std::min(at, bytes.size()));
  return std::search(data, bytes.end(), kEnd.begin(), kEnd.end()) != bytes.end();
}

/// Palette, colour and depth are OpenCV's, but for some TIFFs; only JPEG carries an EXIF orientation, which
/// IMREAD_UNCHANGED skips.
cv::Mat decode(const fs::path& file, const std::vector<std::uint8_t>& bytes, const ImageHeader& header) {
  const ImageFormat format = header.format;
  const int flags = format == ImageFormat::Jpeg ? cv::IMREAD_COLOR : cv::IMREAD_UNCHANGED;
  if (format == ImageFormat::Jpeg && !ends_as_jpeg(bytes))
    throw Error(file.string(), "is cut off", "copy or export it again");
  cv::Mat picture;
  const QuietStderr quiet;
  try {
    picture = is_packed_tiff(header) ? decode_packed_tiff(bytes, header) : cv::imdecode(bytes, flags);
  } catch (const cv::Exception&) {
    picture.release();
  }
  if (picture.empty()) throw Error(file.string(), "is damaged or cut off", "export it again");
  return picture;
}

/// One row of any channel count and 8-bit depth to grey, its alpha composed on white.
void compose_row(const cv::Mat& row, std::uint8_t* out) {
  cv::Mat grey(1, row.cols, CV_8UC1, out);
  if (row.channels() == 1) {
    row.copyTo(grey);
  } else {
    cv::cvtColor(row, grey, row.channels() == 4 ? cv::COLOR_BGRA2GRAY : cv::COLOR_BGR2GRAY);
  }
  if (row.channels() != 4) return;
  const auto* bgra = row.ptr<std::uint8_t>();
  for (int u = 0; u < row.cols; ++u) {
    const int alpha = bgra[4 * u + 3];
    if (alpha != 255) out[u] = static_cast<std::uint8_t>((out[u] * alpha + 255 * (255 - alpha) + 127) / 255);
  }
}

/// Opponent colours of a row of three or four 8-bit channels, alpha composed on white; whether any is seen.
bool colour_row(const cv::Mat& row, std::uint8_t* red_green, std::uint8_t* yellow_blue) {
  constexpr int kSeen = 12;  // less is the noise of a scanner
  const int channels = row.channels();
  const auto* pixel = row.ptr<std::uint8_t>();
  bool seen = false;
  for (int u = 0; u < row.cols; ++u, pixel += channels) {
    const int alpha = channels == 4 ? pixel[3] : 255;
    const int opposed = (pixel[2] - pixel[1]) * alpha / 510;
    const int warm = (pixel[2] + pixel[1] - 2 * pixel[0]) * alpha / 1020;
    red_green[u] = static_cast<std::uint8_t>(128 + opposed);
    yellow_blue[u] = static_cast<std::uint8_t>(128 + warm);
    seen = seen || std::abs(opposed) > kSeen || std::abs(warm) > kSeen;
  }
  return seen;
}

}  // namespace

GrayImage load_image(const fs::path& file) {
  const auto bytes = read_bytes(file);
  const ImageHeader header = checked_header(file, bytes);
  if (header.format == ImageFormat::Png && longest_pixel(header) == 1.0)
    if (auto pixels = decode_grey_png(bytes))
      return {.width_px = static_cast<int>(header.width_px),
              .height_px = static_cast<int>(header.height_px),
              .pixels = std::move(*pixels),
              .dpi = header.dpi};
  const cv::Mat picture = squared(decode(file, bytes, header), header);
  GrayImage image{
      .width_px = picture.cols, .height_px = picture.rows, .dpi = std::max(header.dpi, header.dpi_v)};
  image.pixels.resize(picture.total());
  const bool colours = picture.channels() >= 3;
  if (colours) image.red_green.resize(picture.total()), image.yellow_blue.resize(picture.total());
  bool seen = false;
  const double to_8_bit = picture.depth() == CV_16U ? 1.0 / 257 : picture.depth() == CV_8U ? 1 : 255;
  for (int v = 0; v < picture.rows; ++v) {
    cv::Mat row = picture.row(v);
    if (picture.depth() != CV_8U) row.convertTo(row, CV_8U, to_8_bit);
    const std::size_t at = static_cast<std::size_t>(v) * static_cast<std::size_t>(picture.cols);
    compose_row(row, &image.pixels[at]);
    if (colours && colour_row(row, &image.red_green[at], &image.yellow_blue[at])) seen = true;
  }
  if (!seen) image.red_green.clear(), image.yellow_blue.clear();
  return image;
}

}  // namespace madori::mapping
