// The S300's serial stream; what is accepted survives its own encoder.
#include <cstdlib>

#include "core/crc16.hpp"
#include "sensors/s300/encode.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace madori::sensors::s300;
  Stream stream([](const Telegram& telegram) {
    (void)fields_of(telegram);
    for (const float range_m : to_laser_scan(telegram).ranges_m)
      if (!(range_m > 0.0F)) std::abort();
    int found = 0;
    Stream again([&](const Telegram& twice) { found += twice == telegram ? 1 : 0; });
    again.push(encode(telegram));
    if (found != 1) std::abort();
  });
  const std::span<const std::uint8_t> bytes(data, size);
  stream.push(bytes.first(size / 2));
  stream.push(bytes.subspan(size / 2));
  // The CRC stops a blind search: offer the same bytes once more with a right one.
  if (size < 26 || size > 2000) return 0;
  std::vector<std::uint8_t> mended(bytes.begin(), bytes.end());
  const std::uint16_t crc = madori::crc16(mended.data() + 4, size - 6);
  mended[size - 2] = static_cast<std::uint8_t>(crc & 0xFFU);
  mended[size - 1] = static_cast<std::uint8_t>(crc >> 8U);
  stream.push(mended);
  return 0;
}
