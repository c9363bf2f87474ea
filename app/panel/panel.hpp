#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/runner/transport_run.hpp"

namespace madori::app {

/// The touch panel of a running vehicle; it closes with this object.
class Panel {
 public:
  Panel() = default;
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;
  virtual ~Panel() = default;

  /// Call after every step of the cycle.
  virtual void observe(const CycleInput& input, const CycleState& state) = 0;
  [[nodiscard]] virtual std::string address() const = 0;
};

/// Serves the panel at `host_port` ("127.0.0.1:8080"; "off" or a page that was never built: no panel, and the
/// second is said). PINs lie in `site`/pins; without loopback one is needed. Throws Error on a bad address.
[[nodiscard]] std::unique_ptr<Panel> open_panel(TransportRun& run, const std::filesystem::path& site,
                                                const std::string& host_port,
                                                const std::filesystem::path& web);

}  // namespace madori::app
