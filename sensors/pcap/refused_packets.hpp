#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "sensors/pcap/udp.hpp"
#include "sensors/vlp16/packet.hpp"

namespace madori::sensors::pcap {

/// The packets of a capture that have the length of a VLP-16's and are none: what they are, in words.
class RefusedPackets {
 public:
  explicit RefusedPackets(std::string file) : file_(std::move(file)) {}

  void count(const UdpPayload& udp);
  /// A packet that does not come from `lidar`. Throws Error where it is a VLP-16's all the same.
  void count_stranger(const UdpPayload& udp, std::uint32_t lidar);
  /// Throws Error with the commonest reason why the capture holds no VLP-16's packet. `cut_packets`: UDP
  /// packets that it holds the beginnings of.
  [[noreturn]] void explain(std::uint64_t cut_packets) const;

 private:
  struct Reason {
    std::uint64_t packets = 0;
    std::uint8_t product = 0, mode = 0;  ///< of the last one
  };

  std::string file_;
  std::array<Reason, vlp16::kPacketFaults> reasons_{};
};

}  // namespace madori::sensors::pcap
