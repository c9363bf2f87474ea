// VLP-16 data and position packets; the first byte chooses, the rest are packets one after the other.
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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  std::span<const std::uint8_t> bytes(data + 1, size - 1);
  if (const auto position = decode_position(bytes))
    require(decode_position(encode(*position))->time_us == position->time_us);
  Assembler assembler([](Frame& frame) { check_frame(frame); }, {static_cast<DualReturn>(data[0] % 3)});
  while (!bytes.empty()) {
    const auto packet = bytes.first(std::min(kDataBytes, bytes.size()));
    DataPacket decoded;
    if (decode(packet, decoded) == PacketFault::None) {
      DataPacket again;
      require(decode(encode(decoded), again) == PacketFault::None && again == decoded);
    }
    assembler.push(packet, {});
    bytes = bytes.subspan(packet.size());
  }
  assembler.flush();
  return 0;
}
