#include "app/iso_time.hpp"

#include <array>
#include <ctime>

#include "core/clock.hpp"

namespace madori::app {

std::string iso_time_utc() {
  const auto now = static_cast<std::time_t>(to_seconds(time_of_day()));
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

}  // namespace madori::app
