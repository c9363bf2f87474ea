#include "app/panel/panel.hpp"

#include <charconv>
#include <chrono>
#include <cstdio>

#include "app/iso_time.hpp"
#include "app/panel/panel_vehicle.hpp"
#include "app/scaled_routes.hpp"
#include "core/result.hpp"
#include "hmi/server/api.hpp"
#include "hmi/server/origin.hpp"
#include "hmi/server/server.hpp"

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

class ServedPanel final : public Panel {
 public:
  ServedPanel(TransportRun& run, const std::filesystem::path& site, const hmi::ServerOptions& options,
              const std::filesystem::path& web)
      : host_(options.host),
        access_(site / "pins", !hmi::host_allowed(options.host, true),
                [] { return std::chrono::steady_clock::now(); }),
        vehicle_(run, site / "madori.db"),
        files_(web),
        editor_(site),
        context_{access_,
                 editor_,
                 vehicle_,
                 job_,
                 iso_time_utc,
                 [site](mapping::SiteTransaction& change, double factor) {
                   stage_scaled_routes(site, change, factor);
                 }},
        server_(options, hmi::make_router(context_), access_, files_, vehicle_) {}

  void observe(const CycleInput& input, const CycleState& state) override { vehicle_.observe(input, state); }
  [[nodiscard]] std::string address() const override {
    return "http://" + host_ + ":" + std::to_string(server_.port()) + "/";
  }

 private:
  std::string host_;
  hmi::Access access_;
  PanelVehicle vehicle_;
  hmi::StaticFiles files_;
  hmi::SiteEditor editor_;
  hmi::Job job_;
  hmi::ApiContext context_;
  hmi::Server server_;  ///< last: its threads use all of the above
};

}  // namespace

std::unique_ptr<Panel> open_panel(TransportRun& run, const std::filesystem::path& site,
                                  const std::string& host_port, const std::filesystem::path& web) {
  if (host_port == "off") return nullptr;
  if (!std::filesystem::exists(web / "index.html")) {
    std::fprintf(stderr, "no panel: %s holds no built page; build it: cmake --build build/release --target panel\n",
                 web.c_str());
    return nullptr;
  }
  return std::make_unique<ServedPanel>(run, site, parse_address(host_port), web);
}

}  // namespace madori::app
