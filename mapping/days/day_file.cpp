#include "mapping/days/day_file.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "mapping/picture/grey_png.hpp"
#include "mapping/picture/image_header.hpp"

namespace madori::mapping {
namespace {

constexpr std::size_t kHead = 33;  // signature and IHDR (PNG 1.2, 3.1 and 4.1.1)
constexpr std::size_t kChunkName = 4, kLength = 4;
constexpr std::string_view kKeyword("tEXtmadori-day\0", 15);
constexpr int kVersion = 1;
constexpr int kFarthest = 1 << 20;  // columns and rows: 262 km
constexpr int kStates = 6;

std::string big_endian(std::uint32_t value) {
  std::string bytes(4, '\0');
  for (int i = 0; i < 4; ++i) bytes[static_cast<std::size_t>(i)] = static_cast<char>(value >> (24 - 8 * i));
  return bytes;
}

std::string place_chunk(const DayMap& map) {
  const std::string named =
      std::string(kKeyword) + fmt::format("{} {} {} {:.9g} {} {}", kVersion, to_text(map.day), map.frame,
                                          map.cell_m, map.column, map.row);
  return big_endian(static_cast<std::uint32_t>(named.size() - kChunkName)) + named +
         big_endian(libdeflate_crc32(0, named.data(), named.size()));
}

/// The text behind the keyword; empty where the chunk is another one. Its CRC was seen to be right.
std::string place_text(std::string_view png) {
  const std::string_view chunk = png.substr(std::min(png.size(), kHead));
  if (chunk.size() < kLength || chunk.substr(kLength, kKeyword.size()) != kKeyword) return "";
  const auto byte = [&](std::size_t i) { return std::uint32_t{static_cast<std::uint8_t>(chunk[i])}; };
  const std::size_t length = byte(0) << 24U | byte(1) << 16U | byte(2) << 8U | byte(3);
  const std::size_t begin = kLength + kKeyword.size();
  if (length < kKeyword.size() - kChunkName || chunk.size() < kLength + kChunkName + length) return "";
  return std::string(chunk.substr(begin, length - (kKeyword.size() - kChunkName)));
}

bool read_place(const std::string& text, DayMap& map) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  int version = 0;
  std::string date;
  in >> version >> date >> map.frame >> map.cell_m >> map.column >> map.row;
  const auto day = civil_day(date);
  if (in.fail() || version != kVersion || !day) return false;
  map.day = *day;
  const bool is_named =
      map.frame.size() == 16 && map.frame.find_first_not_of("0123456789abcdef") == std::string::npos;
  return is_named && map.cell_m >= 0.01 && map.cell_m <= 10.0 && std::abs(map.column) < kFarthest &&
         std::abs(map.row) < kFarthest;
}

}  // namespace

std::string day_png(const DayMap& map) {
  const cv::Mat picture(map.height, map.width, CV_8UC1, const_cast<std::uint8_t*>(map.packed.data()));
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9}) || bytes.size() < kHead)
    throw Error("the day's map", "cannot be packed", "report this");
  std::string png(bytes.begin(), bytes.end());
  return png.insert(kHead, place_chunk(map));
}

Result<DayMap> parse_day(std::string_view png) {
  const auto refused = [](const char* why) { return Result<DayMap>::failure(why); };
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(png.data()), png.size());
  const auto header = read_image_header(bytes);
  if (!header || header->format != ImageFormat::Png) return refused("it is no PNG, or cut short");
  if (header->width_px < 1 || header->height_px < 1 || header->width_px > DayMap::kMostCells ||
      header->height_px > DayMap::kMostCells / header->width_px)
    return refused("it is larger than any day that is kept");
  auto pixels = decode_grey_png(bytes);
  if (!pixels) return refused("it is damaged");
  DayMap map;
  if (!read_place(place_text(png), map)) return refused("it says not what day and place it is of");
  map.width = static_cast<int>(header->width_px);
  map.height = static_cast<int>(header->height_px);
  const auto is_state = [](std::uint8_t value) { return value < kStates * (kOldestDays + 1); };
  if (!std::all_of(pixels->begin(), pixels->end(), is_state)) return refused("it holds unknown states");
  map.packed = std::move(*pixels);
  return map;
}

}  // namespace madori::mapping
