// The journal of a map by driving. The first byte chooses: 0, the file as it is; else records with a right
// checksum, the byte after each 0xFF ending one.
#include <string>
#include <string_view>

#include "app/mapping_drive/drive_journal.hpp"
#include "core/fnv1a.hpp"
#include "tests/fuzz/fuzz_file.hpp"

namespace {

template <class Number>
void put(std::string& file, Number number) {
  file.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string with_sums(std::string_view bytes) {
  std::string file = "MADORI drive 1\n";
  while (!bytes.empty()) {
    const std::string_view payload = bytes.substr(0, bytes.find('\xff'));
    bytes.remove_prefix(std::min(bytes.size(), payload.size() + 1));
    put(file, static_cast<std::uint32_t>(payload.size()));
    file += payload;
    put(file, madori::fnv1a(payload));
  }
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const madori::fuzz::MemoryFile file(".bin");
  if (size == 0) return 0;
  const std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string bytes = data[0] == 0 ? std::string(rest) : with_sums(rest);
  file.write(bytes);
  std::size_t points = 0;
  try {
    const auto whole = madori::app::read_drive(
        file.path(), {[](const madori::OdometryReading&) {},
                      [&](const madori::app::DriveScan& s) { points += s.points.size(); }});
    madori::fuzz::require(whole <= bytes.size());
  } catch (const madori::Error&) {
  }
  madori::fuzz::require(points * 2 * sizeof(float) <= bytes.size());
  return 0;
}
