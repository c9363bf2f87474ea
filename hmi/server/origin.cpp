#include "hmi/server/origin.hpp"

#include <algorithm>
#include <cctype>

namespace madori::hmi {

std::string host_name(std::string_view host_and_port) {
  std::string_view host = host_and_port;
  if (host.starts_with('[')) {
    host = host.substr(0, std::min(host.find(']') + 1, host.size()));
  } else {
    host = host.substr(0, host.find(':'));
  }
  std::string lower(host);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

bool host_allowed(std::string_view host_header, bool loopback_only) {
  const std::string host = host_name(host_header);
  if (host.empty()) return false;
  const bool numeric = host.find_first_not_of("0123456789.") == std::string::npos;
  return !loopback_only || host == "localhost" || host == "[::1]" || (numeric && host.starts_with("127."));
}

bool origin_allowed(std::string_view origin, std::string_view host_header, bool changes_something) {
  if (origin.empty()) return !changes_something;
  constexpr std::string_view kScheme = "http://";
  constexpr std::string_view kSecure = "https://";
  const std::string_view rest = origin.starts_with(kScheme)   ? origin.substr(kScheme.size())
                                : origin.starts_with(kSecure) ? origin.substr(kSecure.size())
                                                              : std::string_view();
  return !rest.empty() && rest == host_header;
}

}  // namespace madori::hmi
