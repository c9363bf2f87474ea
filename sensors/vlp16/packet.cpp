#include "sensors/vlp16/packet.hpp"

#include <algorithm>

#include "sensors/little_endian.hpp"

namespace madori::sensors::vlp16 {
namespace {

constexpr std::size_t kBlockBytes = 100;
constexpr std::size_t kSentenceAt = 206;
constexpr std::size_t kSentenceBytes = 128;

struct Product {
  std::uint8_t code;
  const char* name;
};
constexpr std::array<Product, 5> kOthers{{{0x24, "Puck Hi-Res"},
                                          {0x28, "VLP-32C"},
                                          {0x31, "Velarray"},
                                          {0x63, "VLS-128"},
                                          {0xA1, "VLS-128 (Alpha Prime)"}}};

PacketFault decode_block(const std::uint8_t* at, Block& block) {
  if (at[0] != 0xFF || at[1] != 0xEE) return PacketFault::BlockFlag;
  block.azimuth_cdeg = get_u16_le(at + 2);
  if (block.azimuth_cdeg > 36'000) return PacketFault::Azimuth;
  at += 4;
  for (Return& r : block.returns) {
    r.distance = get_u16_le(at);
    r.reflectivity = at[2];
    at += 3;
  }
  return PacketFault::None;
}

}  // namespace

const char* to_string(PacketFault fault) {
  switch (fault) {
    case PacketFault::None:
      return "good";
    case PacketFault::Length:
      return "not 1206 bytes long";
    case PacketFault::BlockFlag:
      return "a block does not begin with FF EE";
    case PacketFault::Azimuth:
      return "an azimuth beyond 360 degrees, or one that jumps";
    case PacketFault::Time:
      return "a time of an hour or more";
    case PacketFault::Mode:
      return "an unknown return mode";
    case PacketFault::Product:
      return "another product of the maker (its product byte says so)";
  }
  return "unknown";
}

const char* other_product(std::uint8_t product) {
  const auto* found = std::ranges::find(kOthers, product, &Product::code);
  return found == kOthers.end() ? nullptr : found->name;
}

PacketFault decode(std::span<const std::uint8_t> bytes, DataPacket& packet) {
  if (bytes.size() != kDataBytes) return PacketFault::Length;
  const std::uint8_t* const tail = bytes.data() + kBlocks * kBlockBytes;
  packet.time_us = get_u32_le(tail);
  packet.product = tail[5];
  if (other_product(packet.product) != nullptr) return PacketFault::Product;
  if (tail[4] < 0x37 || tail[4] > 0x39) return PacketFault::Mode;
  packet.mode = static_cast<ReturnMode>(tail[4]);
  if (packet.time_us >= kMicrosecondsPerHour) return PacketFault::Time;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const PacketFault fault = decode_block(bytes.data() + b * kBlockBytes, packet.blocks[b]);
    if (fault != PacketFault::None) return fault;
  }
  return PacketFault::None;
}

std::optional<PositionPacket> decode_position(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != kPositionBytes) return std::nullopt;
  PositionPacket packet;
  packet.time_us = get_u32_le(bytes.data() + 198);
  packet.pps = bytes[202];
  if (packet.time_us >= kMicrosecondsPerHour || packet.pps > 3) return std::nullopt;
  const auto sentence = bytes.subspan(kSentenceAt, kSentenceBytes);
  const auto end =
      std::find_if(sentence.begin(), sentence.end(), [](std::uint8_t c) { return c < 0x20 || c > 0x7E; });
  packet.gprmc.assign(sentence.begin(), end);
  if (!packet.gprmc.starts_with("$GPRMC")) packet.gprmc.clear();
  return packet;
}

}  // namespace madori::sensors::vlp16
