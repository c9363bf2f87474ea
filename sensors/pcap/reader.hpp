#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/stamp.hpp"
#include "sensors/pcap/udp.hpp"

namespace madori::sensors::pcap {

/// A UDP packet of a capture. The bytes are valid until the next one is read.
struct CapturedPacket {
  Stamp captured{};
  UdpPayload udp;
};

/// Reads .pcap and .pcapng files (libpcap), UDP over IPv4 only, in the order of the capture.
class PcapReader {
 public:
  /// Throws Error when the file is no capture.
  explicit PcapReader(const std::filesystem::path& file);
  ~PcapReader();
  PcapReader(const PcapReader&) = delete;
  PcapReader& operator=(const PcapReader&) = delete;

  /// Nothing at the end; a capture that was cut short ends there. Throws Error where one is damaged.
  [[nodiscard]] std::optional<CapturedPacket> next();
  /// UDP packets read so far that were left out because the capture holds their beginnings only (tcpdump -s).
  [[nodiscard]] std::uint64_t cut_packets() const { return cut_packets_; }

 private:
  struct Handle;
  [[noreturn]] void refuse(const std::string& why) const;

  std::string file_;
  std::unique_ptr<Handle> handle_;
  std::uint64_t packets_ = 0;  ///< read so far, of any kind
  std::uint64_t cut_packets_ = 0;
};

}  // namespace madori::sensors::pcap
