#include "sensors/rosbag/unpack_chunk.hpp"

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace madori::sensors::rosbag_bridge {
namespace {

constexpr std::size_t kMostBytes = 256U << 20U;
constexpr std::size_t kStep = 1U << 20U;

[[noreturn]] void refuse() {
  throw std::runtime_error("a chunk is damaged");
}

/// Room for what comes next: what a header says that nothing follows costs no memory.
template <class Part>
std::vector<std::uint8_t> grown(std::size_t bytes, Part&& unpack_part) {
  std::vector<std::uint8_t> out;
  for (std::size_t filled = 0; filled < bytes;) {
    out.resize(std::min(bytes, std::max(filled + kStep, 2 * filled)));
    const std::size_t came = unpack_part(out.data() + filled, out.size() - filled);
    if (came == 0) refuse();
    filled += came;
    out.resize(filled);
  }
  return out;
}

std::vector<std::uint8_t> from_lz4(Bytes packed, std::size_t bytes) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, LZ4F_freeDecompressionContext);
  return grown(bytes, [&](std::uint8_t* to, std::size_t room) {
    for (;;) {
      std::size_t came = room, taken = packed.size();
      if (LZ4F_isError(LZ4F_decompress(context.get(), to, &came, packed.data(), &taken, nullptr)) != 0)
        refuse();
      packed = packed.subspan(taken);
      if (came > 0) return came;
      if (taken == 0) refuse();
    }
  });
}

std::vector<std::uint8_t> from_bz2(std::vector<std::uint8_t> packed, std::size_t bytes) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> end(&stream, BZ2_bzDecompressEnd);
  stream.next_in = reinterpret_cast<char*>(packed.data());
  stream.avail_in = static_cast<unsigned>(packed.size());
  return grown(bytes, [&](std::uint8_t* to, std::size_t room) {
    stream.next_out = reinterpret_cast<char*>(to);
    stream.avail_out = static_cast<unsigned>(room);
    const int state = BZ2_bzDecompress(&stream);
    if (state != BZ_OK && state != BZ_STREAM_END) refuse();
    return room - stream.avail_out;
  });
}

}  // namespace

std::vector<std::uint8_t> unpacked(std::vector<std::uint8_t> packed, const std::string& compression,
                                   std::uint32_t bytes) {
  if (bytes > kMostBytes) throw std::runtime_error("a chunk is larger than 256 MiB");
  if (compression == "lz4") return from_lz4(packed, bytes);
  if (compression == "bz2") return from_bz2(std::move(packed), bytes);
  if (compression == "none" && packed.size() != bytes) refuse();
  if (compression == "none") return packed;
  throw std::runtime_error("it is packed by " + compression);
}

}  // namespace madori::sensors::rosbag_bridge
