#pragma once

#include <string>
#include <string_view>

namespace madori::hmi {

/// The host of "example:8080" or "[::1]:8080", without the port, lower case.
[[nodiscard]] std::string host_name(std::string_view host_and_port);

/// True where the Host header names this machine as it was bound: on loopback only loopback names pass, which
/// stops DNS rebinding; on a network any host passes, since sessions guard it.
[[nodiscard]] bool host_allowed(std::string_view host_header, bool loopback_only);

/// True where a browser's Origin is the page of this server: "http://" + Host. No Origin passes only for
/// requests that change nothing.
[[nodiscard]] bool origin_allowed(std::string_view origin, std::string_view host_header,
                                  bool changes_something);

}  // namespace madori::hmi
