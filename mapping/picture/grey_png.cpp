#include "mapping/picture/grey_png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

namespace madori::mapping {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr std::size_t kSignature = 8, kAroundChunk = 12, kHeaderSize = 13;
constexpr std::size_t kMostDeflated = 1032;  // bytes that one byte of DEFLATE can stand for

std::uint32_t u32(const std::uint8_t* at) {
  return std::uint32_t{at[0]} << 24U | std::uint32_t{at[1]} << 16U | std::uint32_t{at[2]} << 8U | at[3];
}

struct Chunk {
  std::string_view type;
  Bytes data;

  [[nodiscard]] bool may_be_skipped() const { return type.front() >= 'a'; }  // PNG 1.2, 3.3: small letters
};

/// The whole chunk at the head of `rest`, which moves behind it; nothing where it is cut off or damaged.
std::optional<Chunk> next_chunk(Bytes& rest) {
  if (rest.size() < kAroundChunk) return std::nullopt;
  const std::size_t length = u32(rest.data());
  if (length > rest.size() - kAroundChunk) return std::nullopt;
  const Chunk chunk{{reinterpret_cast<const char*>(&rest[4]), 4}, rest.subspan(8, length)};
  if (libdeflate_crc32(0, &rest[4], length + 4) != u32(&rest[8 + length])) return std::nullopt;
  rest = rest.subspan(kAroundChunk + length);
  return chunk;
}

struct Packed {
  std::size_t width = 0, height = 0;
  std::vector<std::uint8_t> data;  // of all IDAT chunks
};

std::optional<Packed> unpack_chunks(Bytes rest) {
  if (rest.size() < kSignature) return std::nullopt;
  rest = rest.subspan(kSignature);
  const auto header = next_chunk(rest);
  constexpr std::array<std::uint8_t, 5> kPlainGrey{8, 0, 0, 0, 0};  // depth, colour, ..., interlacing
  if (!header || header->type != "IHDR" || header->data.size() != kHeaderSize ||
      !std::equal(kPlainGrey.begin(), kPlainGrey.end(), header->data.begin() + 8))
    return std::nullopt;
  Packed packed{u32(header->data.data()), u32(&header->data[4]), {}};
  packed.data.reserve(rest.size());
  bool data_ended = false;
  for (auto chunk = next_chunk(rest); chunk; chunk = next_chunk(rest)) {
    if (chunk->type == "IEND") return packed;
    const bool pixels = chunk->type == "IDAT";
    if (chunk->type == "tRNS" || (!pixels && !chunk->may_be_skipped())) return std::nullopt;
    if (!pixels) {
      data_ended = !packed.data.empty();
      continue;
    }
    if (data_ended) return std::nullopt;
    packed.data.insert(packed.data.end(), chunk->data.begin(), chunk->data.end());
  }
  return std::nullopt;
}

std::uint8_t paeth(int left, int above, int corner) {
  const int by_left = std::abs(above - corner), by_above = std::abs(left - corner),
            by_corner = std::abs(left + above - 2 * corner);
  if (by_left <= by_above && by_left <= by_corner) return static_cast<std::uint8_t>(left);
  return static_cast<std::uint8_t>(by_above <= by_corner ? above : corner);
}

using Lanes [[gnu::vector_size(16)]] = std::uint8_t;

Lanes load(const std::uint8_t* at) {
  Lanes lanes;
  std::memcpy(&lanes, at, sizeof(lanes));
  return lanes;
}

/// Each pixel is told as what it has more than the one before it. Sixteen at once.
void sum_along(const std::uint8_t* in, std::uint8_t* out, std::size_t width) {
  constexpr Lanes kNone{};
  std::uint8_t left = 0;
  std::size_t i = 0;
  for (; i + sizeof(Lanes) <= width; i += sizeof(Lanes)) {
    Lanes sum = load(in + i);
    sum +=
        __builtin_shufflevector(kNone, sum, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30);
    sum +=
        __builtin_shufflevector(kNone, sum, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29);
    sum +=
        __builtin_shufflevector(kNone, sum, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27);
    sum += __builtin_shufflevector(kNone, sum, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23);
    const Lanes pixels = sum + left;
    std::memcpy(out + i, &pixels, sizeof(pixels));
    left = static_cast<std::uint8_t>(left + sum[sizeof(Lanes) - 1]);
  }
  for (; i < width; ++i) out[i] = left = static_cast<std::uint8_t>(in[i] + left);
}

/// Than the one above it.
void sum_down(const std::uint8_t* in, const std::uint8_t* above, std::uint8_t* out, std::size_t width) {
  std::size_t i = 0;
  for (; i + sizeof(Lanes) <= width; i += sizeof(Lanes)) {
    const Lanes pixels = load(in + i) + load(above + i);
    std::memcpy(out + i, &pixels, sizeof(pixels));
  }
  for (; i < width; ++i) out[i] = static_cast<std::uint8_t>(in[i] + above[i]);
}

/// Takes the filter off a row; `out` may lie before `in` in the same memory. The left neighbour is carried
/// in a register: reading it back from memory would take most of the time.
bool unfilter(std::uint8_t filter, const std::uint8_t* in, const std::uint8_t* above, std::uint8_t* out,
              std::size_t width) {
  std::uint8_t left = 0, corner = 0;
  const auto each = [&](auto predicted) {
    for (std::size_t i = 0; i < width; ++i)
      out[i] = left = static_cast<std::uint8_t>(in[i] + predicted(above[i]));
  };
  switch (filter) {
    case 0:
      std::memmove(out, in, width);
      return true;
    case 1:
      sum_along(in, out, width);
      return true;
    case 2:
      sum_down(in, above, out, width);
      return true;
    case 3:
      each([&](std::uint8_t up) { return (left + up) / 2; });
      return true;
    case 4:
      each([&](std::uint8_t up) {
        const std::uint8_t value = paeth(left, up, corner);
        corner = up;
        return value;
      });
      return true;
    default:
      return false;
  }
}

}  // namespace

std::optional<std::vector<std::uint8_t>> decode_grey_png(Bytes bytes) {
  const auto packed = unpack_chunks(bytes);
  if (!packed || packed->width == 0 || packed->height == 0) return std::nullopt;
  const std::size_t width = packed->width, stride = width + 1;
  if (packed->height > kMostDeflated * packed->data.size() / stride) return std::nullopt;
  std::vector<std::uint8_t> pixels(stride * packed->height);
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflater(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!inflater || libdeflate_zlib_decompress(inflater.get(), packed->data.data(), packed->data.size(),
                                              pixels.data(), pixels.size(), nullptr) != LIBDEFLATE_SUCCESS)
    return std::nullopt;
  const std::vector<std::uint8_t> blank(width, 0);
  const std::uint8_t* above = blank.data();
  for (std::size_t v = 0; v < packed->height; ++v) {  // in place: each row moves v + 1 bytes to the front
    const std::uint8_t* in = &pixels[v * stride];
    std::uint8_t* out = &pixels[v * width];
    if (!unfilter(in[0], in + 1, above, out, width)) return std::nullopt;
    above = out;
  }
  pixels.resize(width * packed->height);
  return pixels;
}

}  // namespace madori::mapping
