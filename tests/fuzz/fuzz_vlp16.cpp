// VLP-16 data and position packets; the first byte chooses, the rest are packets one after the other. From
// 128 on each packet is filled up and gets what a blind search does not find: length, flags, a mode.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "sensors/vlp16/assembler.hpp"
#include "sensors/vlp16/encode.hpp"

using namespace madori::sensors::vlp16;

namespace {

void require(bool good) {
  if (!good) std::abort();
}

void check_frame(const Frame& frame) {
  for (const auto& p : frame.cloud.points) {
    const float range_m = std::hypot(p.x_m, p.y_m, p.z_m);
    require(range_m > 0.0F && range_m < 132.0F && p.ring < 16 && p.time_offset_s >= 0.0F);
  }
}

std::array<std::uint8_t, kDataBytes> mended(std::span<const std::uint8_t> piece) {
  std::array<std::uint8_t, kDataBytes> packet{};
  std::ranges::copy(piece, packet.begin());
  constexpr std::size_t kBlockBytes = 100;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    packet[block * kBlockBytes] = 0xFF, packet[block * kBlockBytes + 1] = 0xEE;
    packet[block * kBlockBytes + 3] %= 0x8C;  // azimuth, below 360 degrees
  }
  packet[1203] %= 0xD6;  // time, below an hour
  packet[1204] = static_cast<std::uint8_t>(0x37 + packet[1204] % 3);
  packet[1205] = 0x22;
  return packet;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  std::span<const std::uint8_t> bytes(data + 1, size - 1);
  if (const auto position = decode_position(bytes))
    require(decode_position(encode(*position))->time_us == position->time_us);
  Assembler assembler([](Frame& frame) { check_frame(frame); }, {static_cast<DualReturn>(data[0] % 3)});
  while (!bytes.empty()) {
    const auto piece = bytes.first(std::min(kDataBytes, bytes.size()));
    const auto whole = data[0] < 128 ? std::array<std::uint8_t, kDataBytes>{} : mended(piece);
    const auto packet = data[0] < 128 ? piece : std::span<const std::uint8_t>(whole);
    DataPacket decoded;
    if (decode(packet, decoded) == PacketFault::None) {
      DataPacket again;
      require(decode(encode(decoded), again) == PacketFault::None && again == decoded);
    }
    assembler.push(packet, {});
    bytes = bytes.subspan(piece.size());
  }
  assembler.flush();
  return 0;
}
