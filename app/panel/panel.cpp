#include "app/panel/panel.hpp"

#include <charconv>
#include <chrono>
#include <cstdio>

#include "app/iso_time.hpp"
#include "app/panel/panel_preview.hpp"
#include "app/panel/panel_vehicle.hpp"
#include "app/scaled_routes.hpp"
#include "core/result.hpp"
#include "hmi/server/api.hpp"
#include "hmi/server/origin.hpp"
#include "hmi/server/server.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_versions.hpp"

namespace madori::app {
namespace {

hmi::ServerOptions parse_address(const std::string& host_port) {
  hmi::ServerOptions options;
  const std::size_t colon = host_port.rfind(':');
  const std::string port = colon == std::string::npos ? "" : host_port.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), options.port);
  if (error != std::errc() || end != port.data() + port.size() || colon == 0)
    throw Error("--hmi " + host_port, "is no HOST:PORT", "give one like 127.0.0.1:8080");
  options.host = host_port.substr(0, colon);
  return options;
}

/// The camera that the command line or the site names; empty for none.
std::string camera_of(const PanelOptions& options) {
  if (!options.camera.empty() || !std::filesystem::exists(options.site / "site.yaml")) return options.camera;
  return mapping::load_site(options.site).camera;
}

class ServedPanel final : public Panel {
 public:
  ServedPanel(SiteRun& run, const PanelOptions& options, const hmi::ServerOptions& server)
      : host_(server.host),
        access_(options.site / "pins", !hmi::host_allowed(server.host, true),
                [] { return std::chrono::steady_clock::now(); }),
        vehicle_(run, options.site / "madori.db", options.devices, camera_of(options)),
        files_(options.web),
        editor_(options.site),
        context_{access_,
                 editor_,
                 vehicle_,
                 job_,
                 replay_,
                 iso_time_utc,
                 [site = options.site](mapping::SiteTransaction& change, double factor) {
                   stage_scaled_routes(site, change, factor);
                 },
                 preview_drawing,
                 options.metrics},
        server_(server, context_, files_) {}

  void begin_run() override { vehicle_.begin_run(); }
  void observe(const CycleInput& input, const CycleState& state, const TransportRun& run) override {
    vehicle_.observe(input, state, run);
  }
  void idle(const CycleInput& input) override { vehicle_.idle(input); }
  [[nodiscard]] std::string address() const override {
    return "http://" + host_ + ":" + std::to_string(server_.port()) + "/";
  }

 private:
  std::string host_;
  hmi::Access access_;
  PanelVehicle vehicle_;
  hmi::StaticFiles files_;
  hmi::SiteEditor editor_;
  hmi::Replay replay_;
  hmi::ApiContext context_;
  hmi::Job job_;        ///< its work uses all of the above
  hmi::Server server_;  ///< last: its threads use all of them
};

}  // namespace

std::unique_ptr<Panel> open_panel(SiteRun& run, const PanelOptions& options) {
  if (options.host_port == "off") return nullptr;
  if (!std::filesystem::exists(options.web / "index.html")) {
    std::fprintf(stderr,
                 "no panel: %s holds no built page; build it: cmake --build build/release --target panel\n",
                 options.web.c_str());
    return nullptr;
  }
  std::filesystem::create_directories(options.site);
  mapping::set_version_author("panel");
  return std::make_unique<ServedPanel>(run, options, parse_address(options.host_port));
}

}  // namespace madori::app
