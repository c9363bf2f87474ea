#include "mapping/picture/image_header.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace madori::mapping {
namespace {

constexpr double kInch = 0.0254;

/// Bytes read as integers of either order; reading past the end gives zero.
class Reader {
 public:
  Reader(std::span<const std::uint8_t> bytes, bool big_endian) : bytes_(bytes), big_(big_endian) {}

  [[nodiscard]] std::uint32_t integer(std::size_t at, std::size_t count) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t where = at + (big_ ? i : count - 1 - i);
      value = value << 8U | (where < bytes_.size() ? bytes_[where] : 0U);
    }
    return value;
  }
  [[nodiscard]] std::uint32_t u16(std::size_t at) const { return integer(at, 2); }
  [[nodiscard]] std::uint32_t u32(std::size_t at) const { return integer(at, 4); }
  [[nodiscard]] bool is(std::size_t at, std::string_view word) const {
    const auto text = at < bytes_.size() ? bytes_.subspan(at) : std::span<const std::uint8_t>();
    return text.size() >= word.size() && std::equal(word.begin(), word.end(), text.begin());
  }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

 private:
  std::span<const std::uint8_t> bytes_;
  bool big_;
};

template <std::size_t N>
bool starts_with(std::span<const std::uint8_t> bytes, const std::array<std::uint8_t, N>& magic) {
  return bytes.size() >= N && std::equal(magic.begin(), magic.end(), bytes.begin());
}

int png_bytes_per_px(const Reader& read) {
  constexpr int kGrey = 0, kColour = 2, kPalette = 3;  // the others have alpha, and are decoded to four
  const auto kind = static_cast<int>(read.integer(25, 1));
  const int channels = kind == kGrey ? 1 : kind == kColour || kind == kPalette ? 3 : 4;
  return read.integer(24, 1) == 16 ? 2 * channels : channels;
}

ImageHeader png(std::span<const std::uint8_t> bytes) {
  const Reader read(bytes, true);
  ImageHeader header{ImageFormat::Png, read.u32(16), read.u32(20), 0, png_bytes_per_px(read)};
  for (std::size_t at = 8; at + 12 <= read.size();) {
    if (read.is(at + 4, "IDAT")) break;
    if (read.is(at + 4, "pHYs") && read.integer(at + 16, 1) == 1) {
      header.dpi = read.u32(at + 8) * kInch;
      header.dpi_v = read.u32(at + 12) * kInch;
    }
    at += 12 + static_cast<std::size_t>(read.u32(at));
  }
  return header;
}

void read_jfif(const Reader& read, std::size_t at, ImageHeader& header) {
  const std::uint32_t unit = read.is(at + 4, "JFIF") ? read.integer(at + 11, 1) : 0;
  const double inches = unit == 1 ? 1 : unit == 2 ? 2.54 : 0;
  header.dpi = read.u16(at + 12) * inches;
  header.dpi_v = read.u16(at + 14) * inches;
}

ImageHeader jpeg(std::span<const std::uint8_t> bytes) {
  const Reader read(bytes, true);
  ImageHeader header{ImageFormat::Jpeg, 0, 0, 0, 3};
  for (std::size_t at = 2; at + 9 <= read.size() && read.integer(at, 1) == 0xFF;) {
    const std::uint32_t marker = read.integer(at + 1, 1);
    if (marker == 0xE0) read_jfif(read, at, header);
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) {
      header.height_px = read.u16(at + 5);
      header.width_px = read.u16(at + 7);
      break;
    }
    at += marker == 0xFF ? 1 : 2 + std::max<std::size_t>(2, read.u16(at + 2));
  }
  return header;
}

constexpr std::uint32_t kTiffPalette = 3;

ImageHeader tiff(std::span<const std::uint8_t> bytes) {
  const Reader read(bytes, bytes[0] == 'M');
  ImageHeader header{ImageFormat::Tiff, 0, 0, 0};
  const std::size_t directory = read.u32(4);
  const auto ratio = [&](std::uint32_t where) {
    return read.u32(where) / std::max(1.0, 1.0 * read.u32(std::size_t{where} + 4));
  };
  std::uint32_t unit = 2, bits = 1, samples = 1;
  for (std::size_t i = 0; i < read.u16(directory); ++i) {
    const std::size_t at = directory + 2 + 12 * i;
    const std::uint32_t value = read.u16(at + 2) == 3 ? read.u16(at + 8) : read.u32(at + 8);
    switch (read.u16(at)) {
      case 256:
        header.width_px = value;
        break;
      case 257:
        header.height_px = value;
        break;
      case 258:  // one a sample, elsewhere where they do not fit in here
        bits = read.u32(at + 4) > 2 ? read.u16(read.u32(at + 8)) : value;
        break;
      case 262:
        if (value == kTiffPalette) samples = std::max(samples, 3U);
        break;
      case 277:
        samples = std::max(samples, value);
        header.samples = static_cast<int>(std::min(value, 64U));
        break;
      case 274:
        header.orientation = static_cast<int>(std::min(value, 8U));
        break;
      case 282:
        header.dpi = ratio(value);
        break;
      case 283:
        header.dpi_v = ratio(value);
        break;
      case 296:
        unit = value;
        break;
      default:
        break;
    }
  }
  header.bits = static_cast<int>(std::min(bits, 64U));
  header.bytes_per_px = static_cast<int>(std::clamp(samples, 1U, 4U) * std::clamp((bits + 7) / 8, 1U, 8U));
  const double inches = unit == 2 ? 1 : unit == 3 ? 2.54 : 0;
  header.dpi *= inches;
  header.dpi_v *= inches;
  return header;
}

ImageHeader bmp(std::span<const std::uint8_t> bytes) {
  const Reader read(bytes, false);
  if (read.u32(14) == 12) return {ImageFormat::Bmp, read.u16(18), read.u16(20), 0, 3};
  const std::int64_t height = static_cast<std::int32_t>(read.u32(22));  // negative: top-down
  const int bytes_per_px = read.u16(28) == 32 ? 4 : 3;
  return {ImageFormat::Bmp,     read.u32(18), height < 0 ? -height : height,
          read.u32(38) * kInch, bytes_per_px, read.u32(42) * kInch};
}

std::optional<ImageHeader> header_of(std::span<const std::uint8_t> bytes) {
  using Four = std::array<std::uint8_t, 4>;
  if (starts_with(bytes, std::array<std::uint8_t, 8>{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'}))
    return png(bytes);
  if (starts_with(bytes, std::array<std::uint8_t, 3>{0xFF, 0xD8, 0xFF})) return jpeg(bytes);
  if (starts_with(bytes, Four{'I', 'I', 42, 0}) || starts_with(bytes, Four{'M', 'M', 0, 42}))
    return tiff(bytes);
  if (starts_with(bytes, std::array<std::uint8_t, 2>{'B', 'M'}) && bytes.size() >= 26) return bmp(bytes);
  return std::nullopt;
}

}  // namespace

std::optional<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes) {
  constexpr double kLeastDpi = 1.0, kMostDpi = 100'000.0;
  constexpr double kLongestPixel = 4.0;  // of a fax 2.1: what states more than this has no such pixels
  auto header = header_of(bytes);
  if (!header) return header;
  if (!(header->dpi >= kLeastDpi && header->dpi <= kMostDpi)) header->dpi = 0;
  const bool both =
      header->dpi_v >= header->dpi / kLongestPixel && header->dpi_v <= header->dpi * kLongestPixel;
  if (!both) header->dpi_v = header->dpi;
  return header;
}

}  // namespace madori::mapping
