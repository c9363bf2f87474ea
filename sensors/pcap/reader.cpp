#include "sensors/pcap/reader.hpp"

#include <pcap/pcap.h>

#include <array>

#include "core/result.hpp"

namespace madori::sensors::pcap {

struct PcapReader::Handle {
  pcap_t* capture = nullptr;
  int link_type = 0;
  Handle() = default;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (capture != nullptr) pcap_close(capture);
  }
};

PcapReader::PcapReader(const std::filesystem::path& file) : handle_(std::make_unique<Handle>()) {
  std::array<char, PCAP_ERRBUF_SIZE> problem{};
  handle_->capture =
      pcap_open_offline_with_tstamp_precision(file.c_str(), PCAP_TSTAMP_PRECISION_NANO, problem.data());
  if (handle_->capture == nullptr)
    throw Error(file.string(), std::string("is no packet capture: ") + problem.data(),
                "record one with tcpdump -w or Wireshark");
  handle_->link_type = pcap_datalink(handle_->capture);
}

PcapReader::~PcapReader() = default;

std::optional<CapturedPacket> PcapReader::next() {
  pcap_pkthdr* header = nullptr;
  const u_char* bytes = nullptr;
  while (true) {
    const int outcome = pcap_next_ex(handle_->capture, &header, &bytes);
    if (outcome != 1) {
      truncated_ = outcome == PCAP_ERROR;
      return std::nullopt;
    }
    const auto udp = udp_payload({bytes, header->caplen}, handle_->link_type);
    if (!udp) continue;
    // With nanosecond precision asked for, tv_usec holds nanoseconds.
    const Stamp captured(std::chrono::seconds(header->ts.tv_sec) +
                         std::chrono::nanoseconds(header->ts.tv_usec));
    return CapturedPacket{captured, *udp};
  }
}

}  // namespace madori::sensors::pcap
