#include "app/iso_time.hpp"

#include <array>
#include <ctime>

#include "core/clock.hpp"

namespace madori::app {

std::string iso_time_utc() {
  return iso_time_of(to_seconds(time_of_day()));
}

std::string iso_time_of(double stamp_s) {
  const auto now = static_cast<std::time_t>(stamp_s);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

}  // namespace madori::app
