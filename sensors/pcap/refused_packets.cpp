#include "sensors/pcap/refused_packets.hpp"

#include <algorithm>
#include <cstdio>

#include "core/result.hpp"

namespace madori::sensors::pcap {
namespace {

using vlp16::PacketFault;

constexpr std::size_t kModeAt = vlp16::kDataBytes - 2, kProductAt = vlp16::kDataBytes - 1;

std::string address_text(std::uint32_t address) {
  std::string text;
  for (const unsigned shift : {24U, 16U, 8U, 0U})
    text += (text.empty() ? "" : ".") + std::to_string((address >> shift) & 0xFFU);
  return text;
}

std::string hexadecimal(std::uint8_t byte) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "0x%02X", static_cast<unsigned>(byte));
  return text.data();
}

}  // namespace

void RefusedPackets::count(const UdpPayload& udp) {
  vlp16::DataPacket packet;
  PacketFault fault = vlp16::decode(udp.bytes, packet);
  if (fault == PacketFault::None) fault = PacketFault::Azimuth;  // the assembler's: it jumps
  Reason& reason = reasons_.at(static_cast<std::size_t>(fault));
  ++reason.packets;
  if (udp.bytes.size() != vlp16::kDataBytes) return;
  reason.product = udp.bytes[kProductAt];
  reason.mode = udp.bytes[kModeAt];
}

void RefusedPackets::count_stranger(const UdpPayload& udp, std::uint32_t lidar) {
  vlp16::DataPacket packet;
  if (vlp16::decode(udp.bytes, packet) != PacketFault::None) return count(udp);
  throw Error(
      file_,
      "holds the packets of several VLP-16 (" + address_text(lidar) + ", " + address_text(udp.source) + ")",
      "choose one with a capture filter: tcpdump -r FILE -w ONE.pcap src host " + address_text(lidar));
}

void RefusedPackets::explain(std::uint64_t cut_packets) const {
  const auto* most = std::ranges::max_element(reasons_, {}, &Reason::packets);
  const auto fault = static_cast<PacketFault>(most - reasons_.begin());
  if (cut_packets > most->packets)
    throw Error(file_, "holds the beginnings of " + std::to_string(cut_packets) + " UDP packets only",
                "capture whole packets: tcpdump -s 0");
  if (most->packets == 0)
    throw Error(file_, "holds no VLP-16 data packets", "capture the sensor's UDP port 2368");
  const char* product = vlp16::other_product(most->product);
  if (fault == PacketFault::Product && product != nullptr)
    throw Error(file_, std::string("holds packets of another sensor (") + product + ")",
                "only the VLP-16 is supported");
  if (fault == PacketFault::Mode)
    throw Error(file_, "holds packets of an unknown return mode (" + hexadecimal(most->mode) + ")",
                "set the sensor's return type to Strongest, Last or Dual, and capture again");
  throw Error(file_,
              "holds no VLP-16 data packets, but " + std::to_string(most->packets) +
                  " of their length: " + vlp16::to_string(fault),
              "capture the UDP port 2368 of a VLP-16");
}

}  // namespace madori::sensors::pcap
