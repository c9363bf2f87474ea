#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace madori::sensors::pcap {

struct UdpPayload {
  std::uint16_t destination_port = 0;
  std::span<const std::uint8_t> bytes;
  std::uint32_t source = 0;  ///< IPv4 address, the first number in the highest byte
  bool cut_short = false;    ///< the capture holds the beginning only; `bytes` is empty then
};

/// The UDP payload of a captured link-layer frame. `link_type` is libpcap's DLT value: Ethernet (with VLAN
/// tags), raw IP, BSD loopback, Linux "cooked" 1 and 2. Nothing for other traffic and IP fragments.
[[nodiscard]] std::optional<UdpPayload> udp_payload(std::span<const std::uint8_t> frame, int link_type);

}  // namespace madori::sensors::pcap
