#include "sensors/pcap/udp.hpp"

namespace madori::sensors::pcap {
namespace {

constexpr int kNull = 0, kEthernet = 1, kRaw = 12, kRawAlso = 101, kLoop = 108, kLinuxSll = 113, kIpv4 = 228,
              kLinuxSll2 = 276;
constexpr unsigned kEtherIpv4 = 0x0800, kEtherVlan = 0x8100, kEtherQinq = 0x88A8;
constexpr unsigned kUdp = 17;

using Bytes = std::span<const std::uint8_t>;

/// Big-endian; the caller has checked the length.
unsigned word(Bytes bytes, std::size_t at) {
  return (static_cast<unsigned>(bytes[at]) << 8U) | bytes[at + 1];
}

std::optional<Bytes> after(Bytes bytes, std::size_t count) {
  if (bytes.size() < count) return std::nullopt;
  return bytes.subspan(count);
}

std::optional<Bytes> ethernet_payload(Bytes frame) {
  std::size_t at = 12;
  while (frame.size() >= at + 4 && (word(frame, at) == kEtherVlan || word(frame, at) == kEtherQinq)) at += 4;
  if (frame.size() < at + 2 || word(frame, at) != kEtherIpv4) return std::nullopt;
  return after(frame, at + 2);
}

std::optional<Bytes> network_layer(Bytes frame, int link_type) {
  switch (link_type) {
    case kEthernet:
      return ethernet_payload(frame);
    case kRaw:
    case kRawAlso:
    case kIpv4:
      return frame;
    case kNull:
    case kLoop:
      return after(frame, 4);
    case kLinuxSll:
      if (frame.size() < 16 || word(frame, 14) != kEtherIpv4) return std::nullopt;
      return after(frame, 16);
    case kLinuxSll2:
      if (frame.size() < 20 || word(frame, 0) != kEtherIpv4) return std::nullopt;
      return after(frame, 20);
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<UdpPayload> udp_payload(Bytes frame, int link_type) {
  const auto ip = network_layer(frame, link_type);
  if (!ip || ip->size() < 20 || (*ip)[0] >> 4U != 4) return std::nullopt;
  const std::size_t header = std::size_t{4} * ((*ip)[0] & 0x0FU);
  const bool fragment = (word(*ip, 6) & 0x3FFFU) != 0;
  if (header < 20 || ip->size() < header + 8 || fragment || (*ip)[9] != kUdp) return std::nullopt;
  // The UDP length counts: some VLP-16 firmware states a wrong IP length in its position packets.
  const Bytes udp = ip->subspan(header);
  const std::size_t length = word(udp, 4);
  if (length < 8) return std::nullopt;
  const bool cut_short = length > udp.size();
  return UdpPayload{static_cast<std::uint16_t>(word(udp, 2)),
                    cut_short ? Bytes() : udp.subspan(8, length - 8),
                    (static_cast<std::uint32_t>(word(*ip, 12)) << 16U) | word(*ip, 14), cut_short};
}

}  // namespace madori::sensors::pcap
