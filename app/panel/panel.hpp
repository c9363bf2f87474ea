#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "app/runner/site_run.hpp"
#include "app/runner/socket_link.hpp"

namespace madori::app {

/// The touch panel of a running vehicle; it closes with this object.
class Panel {
 public:
  Panel() = default;
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;
  virtual ~Panel() = default;

  /// On the cycle's thread: a run begins; after each of its steps; after a tick without a run.
  virtual void begin_run() = 0;
  virtual void observe(const CycleInput& input, const CycleState& state, const TransportRun& run) = 0;
  virtual void idle(const CycleInput& input) = 0;
  [[nodiscard]] virtual std::string address() const = 0;
};

/// Where the panel is served, and of what.
struct PanelOptions {
  std::filesystem::path site;
  std::string host_port = "127.0.0.1:8080";  ///< "off": no panel
  std::filesystem::path web;  ///< the built page; where it was never built: no panel, and that is said
  SocketOptions devices;
  std::string camera;                              ///< instead of the one that site.yaml names
  std::function<std::string()> metrics = nullptr;  ///< of the program, for Prometheus; from any thread
};

/// Serves the panel of `run`. PINs lie in `site`/pins; without loopback one is needed. Throws Error on a bad
/// address. Null where there is no panel.
[[nodiscard]] std::unique_ptr<Panel> open_panel(SiteRun& run, const PanelOptions& options);

}  // namespace madori::app
