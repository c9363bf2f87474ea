#include "sensors/vlp16/encode.hpp"

#include <algorithm>

#include "sensors/little_endian.hpp"

namespace madori::sensors::vlp16 {

std::array<std::uint8_t, kDataBytes> encode(const DataPacket& packet) {
  std::array<std::uint8_t, kDataBytes> bytes{};
  std::uint8_t* at = bytes.data();
  for (const Block& block : packet.blocks) {
    at[0] = 0xFF;
    at[1] = 0xEE;
    put_u16_le(at + 2, block.azimuth_cdeg);
    at += 4;
    for (const Return& r : block.returns) {
      put_u16_le(at, r.distance);
      at[2] = r.reflectivity;
      at += 3;
    }
  }
  put_u32_le(at, packet.time_us);
  at[4] = static_cast<std::uint8_t>(packet.mode);
  at[5] = packet.product;
  return bytes;
}

std::array<std::uint8_t, kPositionBytes> encode(const PositionPacket& packet) {
  std::array<std::uint8_t, kPositionBytes> bytes{};
  put_u32_le(bytes.data() + 198, packet.time_us);
  bytes[202] = packet.pps;
  if (packet.gprmc.empty()) return bytes;
  const std::size_t length = std::min<std::size_t>(packet.gprmc.size(), 126);
  std::copy_n(packet.gprmc.begin(), length, bytes.begin() + 206);
  bytes[206 + length] = '\r';
  bytes[207 + length] = '\n';
  return bytes;
}

}  // namespace madori::sensors::vlp16
