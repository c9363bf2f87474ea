#include <algorithm>
#include <charconv>
#include <cstdio>

#include "core/result.hpp"
#include "sensors/lidar/lidar.hpp"

namespace madori::sensors {

void LidarSettings::refuse_others(std::initializer_list<const char*> keys) const {
  for (const auto& [key, value] : values) {
    if (std::any_of(keys.begin(), keys.end(), [&key = key](const char* known) { return key == known; }))
      continue;
    std::string known;
    for (const char* word : keys) known += std::string(known.empty() ? "" : ", ") + word;
    throw Error("sensor " + name, "the setting \"" + key + "\" is not known",
                known.empty() ? "it has no settings" : "it knows: " + known);
  }
}

double LidarSettings::number_or(const std::string& key, double otherwise, double low, double high) const {
  const auto found = values.find(key);
  if (found == values.end()) return otherwise;
  const std::string& text = found->second;
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && number >= low && number <= high)
    return number;
  const auto round = [](double v) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.10g", v);
    return std::string(digits);
  };
  throw Error("sensor " + name, key + ": \"" + text + "\" is no number that it can be",
              "choose one from " + round(low) + " to " + round(high));
}

HostAndPort host_and_port(const std::string& address, const HostAndPort& otherwise) {
  const std::size_t colon = address.rfind(':');
  HostAndPort result = otherwise;
  if (const std::string host = address.substr(0, colon); !host.empty()) result.host = host;
  if (colon == std::string::npos) return result;
  const char* begin = address.data() + colon + 1;
  const char* end = address.data() + address.size();
  const auto [stop, error] = std::from_chars(begin, end, result.port);
  if (error != std::errc() || stop != end)
    throw Error(address, "is no address", "write HOST:PORT, the port from 0 to 65535");
  return result;
}

}  // namespace madori::sensors
