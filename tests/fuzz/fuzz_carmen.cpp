// Lines of a CARMEN log: whatever is accepted is finite.
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "sensors/carmen/line.hpp"

using namespace madori;

namespace {

void require(bool good) {
  if (!good) std::abort();
}

void check(const sensors::LogRecord& record) {
  if (const auto* scan = std::get_if<sensors::ScanRecord>(&record)) {
    require(!scan->odom_from_base || scan->odom_from_base->is_finite());
    require(std::isfinite(scan->scan.angle_min_rad) && std::isfinite(scan->scan.angle_step_rad) &&
            scan->base_from_lidar.is_finite());
    for (const float range_m : scan->scan.ranges_m) require(range_m > 0.0F);
  } else {
    require(std::get<OdometryReading>(record).odom_from_base.is_finite());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  sensors::carmen::LogParams params;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    params.take(line);
    const auto parsed = sensors::carmen::parse_line(line, params);
    if (parsed && parsed.value()) check(parsed.value()->record);
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return 0;
}
