// site.yaml: what an integrator or an older version wrote, or half of it. A refusal is an Error with words.
#include <cmath>

#include "mapping/site/site_file.hpp"
#include "tests/fuzz/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const madori::fuzz::MemoryFile file(".yaml");
  file.write(data, size);
  try {
    const auto site = madori::mapping::read_site_file(file.path());
    for (const auto& sensor : site.sensors)
      madori::fuzz::require(std::isfinite(sensor.x_m) && std::isfinite(sensor.y_m) &&
                            std::isfinite(sensor.z_m) && std::isfinite(sensor.yaw_deg) &&
                            sensor.protective_m >= 0.0);
  } catch (const madori::Error& e) {
    madori::fuzz::require(e.what()[0] != '\0');
  }
  return 0;
}
