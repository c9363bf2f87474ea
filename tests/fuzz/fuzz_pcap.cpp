// Captured link-layer frames of every kind we read, and whole capture files through libpcap.
#include <stdlib.h>
#include <unistd.h>

#include <string>

#include "core/result.hpp"
#include "sensors/pcap/reader.hpp"

using namespace madori::sensors::pcap;

namespace {

void check(std::span<const std::uint8_t> frame, int link_type) {
  const auto udp = udp_payload(frame, link_type);
  if (!udp || udp->bytes.empty()) return;
  if (udp->bytes.data() < frame.data() || &udp->bytes.back() > &frame.back()) abort();
}

/// One file in memory for the whole run.
struct Scratch {
  Scratch() : descriptor(::mkstemp(path.data())) {}
  ~Scratch() { ::unlink(path.c_str()); }
  std::string path = "/dev/shm/fuzz_pcap_XXXXXX";
  int descriptor;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static Scratch scratch;
  for (const int link_type : {0, 1, 12, 101, 108, 113, 228, 276, 999}) check({data, size}, link_type);
  if (::ftruncate(scratch.descriptor, 0) != 0) return 0;
  if (::pwrite(scratch.descriptor, data, size, 0) != static_cast<ssize_t>(size)) return 0;
  try {
    PcapReader reader(scratch.path);
    while (reader.next()) {
    }
  } catch (const madori::Error&) {
  }
  return 0;
}
