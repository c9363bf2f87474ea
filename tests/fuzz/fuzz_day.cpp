// A kept day of the living map. The first byte chooses: 0, the file as it is; else a right picture with a
// right checksum around what the file says of itself: the text up to 0xFF, then the cells of a map as wide as
// the byte.
#include <libdeflate.h>

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/days/day_file.hpp"
#include "tests/fuzz/fuzz_file.hpp"

namespace {

constexpr std::size_t kHead = 33;  // signature and IHDR

void put_big_endian(std::string& to, std::uint32_t value) {
  for (unsigned shift = 32; shift > 0; shift -= 8) to += static_cast<char>(value >> (shift - 8));
}

std::string file_around(int width, std::string_view rest) {
  const std::string text =
      std::string("tEXtmadori-day\0", 15) + std::string(rest.substr(0, rest.find('\xff')));
  rest.remove_prefix(std::min(rest.size(), text.size() - 14));
  const int height = std::max(1, static_cast<int>(rest.size()) / width);
  cv::Mat picture = cv::Mat::zeros(height, width, CV_8UC1);
  std::copy_n(rest.begin(), std::min(rest.size(), picture.total()), picture.data);
  std::vector<std::uint8_t> bytes;
  madori::fuzz::require(cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1}));
  std::string chunk;
  put_big_endian(chunk, static_cast<std::uint32_t>(text.size() - 4));
  chunk += text;
  put_big_endian(chunk, libdeflate_crc32(0, text.data(), text.size()));
  return std::string(bytes.begin(), bytes.end()).insert(kHead, chunk);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto parsed =
      madori::mapping::parse_day(data[0] == 0 ? std::string(rest) : file_around(data[0], rest));
  if (!parsed) return 0;
  const madori::mapping::DayMap& day = parsed.value();
  madori::fuzz::require(day.packed.size() ==
                        static_cast<std::size_t>(day.width) * static_cast<std::size_t>(day.height));
  const auto again = madori::mapping::parse_day(madori::mapping::day_png(day));
  madori::fuzz::require(again && again.value().packed == day.packed && again.value().day == day.day &&
                        again.value().column == day.column && again.value().row == day.row);
  return 0;
}
