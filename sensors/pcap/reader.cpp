#include "sensors/pcap/reader.hpp"

#include <pcap/pcap.h>

#include <array>
#include <string_view>

#include "core/result.hpp"

namespace madori::sensors::pcap {
namespace {

constexpr std::int64_t kLatestS = 9'000'000'000;  ///< keeps nanoseconds within 64 bits

}  // namespace

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

PcapReader::PcapReader(const std::filesystem::path& file)
    : file_(file.string()), handle_(std::make_unique<Handle>()) {
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
  for (;; ++packets_) {
    const int outcome = pcap_next_ex(handle_->capture, &header, &bytes);
    if (outcome == PCAP_ERROR) {
      const std::string_view why = pcap_geterr(handle_->capture);
      if (why.find("truncated") == std::string_view::npos) refuse(std::string(why));
    }
    if (outcome != 1) return std::nullopt;
    if (header->ts.tv_sec < 0 || header->ts.tv_sec > kLatestS) refuse("the next one's time is out of range");
    const auto udp = udp_payload({bytes, header->caplen}, handle_->link_type);
    if (udp && udp->cut_short) ++cut_packets_;
    if (!udp || udp->cut_short) continue;
    // With nanosecond precision asked for, tv_usec holds nanoseconds.
    const Stamp captured(std::chrono::seconds(header->ts.tv_sec) +
                         std::chrono::nanoseconds(header->ts.tv_usec));
    ++packets_;
    return CapturedPacket{captured, *udp};
  }
}

void PcapReader::refuse(const std::string& why) const {
  throw Error(file_, "is damaged after " + std::to_string(packets_) + " packets: " + why,
              "keep what lies before it with `editcap -r`");
}

}  // namespace madori::sensors::pcap
