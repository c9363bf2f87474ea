#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <thread>

#include "app/commands.hpp"
#include "app/cycle/site_config.hpp"
#include "app/orders/order_store.hpp"
#include "app/runner/device_run.hpp"
#include "core/result.hpp"
#include "planning/route_graph/route_check.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

struct DoctorArguments {
  std::string site;
  SocketOptions devices;
  bool no_devices = false;
};

constexpr std::uintmax_t kRoomForRecordings = 5'000'000'000;

/// Prints one line a check; what fails says what is missing and the mend.
class Checkup {
 public:
  void check(const char* what, const std::function<std::string()>& look) {
    try {
      std::printf("ok       %-10s %s\n", what, look().c_str());
    } catch (const std::exception& e) {
      std::printf("MISSING  %-10s %s\n", what, e.what());
      ++missing_;
    }
  }
  [[nodiscard]] int missing() const { return missing_; }

 private:
  int missing_ = 0;
};

std::string look_at_routes(const fs::path& site, const SiteForDriving& loaded) {
  planning::RouteCheckOptions options;
  options.half_width_m = loaded.config.check.vehicle.half_width_m;
  options.tree_file = (site / "routes/tree.csv").string();
  options.path_file = (site / "routes/path.csv").string();
  for (const auto& finding :
       planning::check_routes(loaded.config.routes, loaded.config.walls->walls(), options))
    if (finding.severity == planning::Severity::Error) throw Error(finding.text());
  return std::to_string(loaded.config.routes.nodes().size()) + " nodes, every station can be reached";
}

std::string look_at_disk(const fs::path& site) {
  const auto free = fs::space(site).available;
  if (free < kRoomForRecordings)
    throw Error(site.string(), "has only " + std::to_string(free / 1'000'000) + " MB left for recordings",
                "free some disk space");
  return std::to_string(free / 1'000'000'000) + " GB left";
}

/// Listens for a moment: both devices speak by themselves.
std::string look_at_devices(const SocketOptions& devices, const WheelGeometry& wheels) {
  SocketLink link(devices, wheels);
  CycleInput heard;
  for (int i = 0; i < 30 && (heard.drive.empty() || heard.clouds.empty()); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    CycleInput now;
    link.collect(now);
    if (!now.drive.empty()) heard.drive = now.drive;
    if (!now.clouds.empty()) heard.clouds = std::move(now.clouds);
  }
  if (heard.clouds.empty())
    throw Error("the VLP-16 is silent",
                "no revolution came on UDP " + std::to_string(devices.lidar_port) + " in 3 s",
                "check its power, its cable, and that it sends to this computer");
  if (heard.drive.empty())
    throw Error("the drive is silent", "no status came on " + devices.drive_device + " in 3 s",
                "check its power, its cable, and --drive");
  const double battery_v = heard.drive.back().battery_mv / 1000.0;
  char text[80];
  std::snprintf(text, sizeof text, "%zu points a revolution, battery %.1f V",
                heard.clouds.back().points.size(), battery_v);
  return text;
}

void run(const DoctorArguments& arguments) {
  const fs::path site(arguments.site);
  Checkup checkup;
  std::unique_ptr<SiteForDriving> loaded;
  checkup.check("site", [&] {
    loaded = std::make_unique<SiteForDriving>(load_for_driving(site));
    return loaded->site.name + ", " + std::to_string(loaded->walls.size()) + " walls";
  });
  if (loaded) checkup.check("routes", [&] { return look_at_routes(site, *loaded); });
  checkup.check("orders", [&] {
    const OrderStore store(site / "madori.db");
    if (const auto verdict = store.integrity(); verdict != "ok")
      throw Error((site / "madori.db").string(), verdict, "restore a backup, or move the file away");
    return std::to_string(store.list(true).size()) + " open";
  });
  checkup.check("disk", [&] { return look_at_disk(site); });
  if (loaded && !arguments.no_devices)
    checkup.check("devices",
                  [&] { return look_at_devices(arguments.devices, loaded->config.odometry.wheels); });
  if (checkup.missing() > 0)
    throw Error(arguments.site, std::to_string(checkup.missing()) + " thing(s) missing",
                "see the lines above");
  std::puts("the vehicle is ready");
}

}  // namespace

void add_doctor(CLI::App& app) {
  auto arguments = std::make_shared<DoctorArguments>();
  CLI::App* command = app.add_subcommand("doctor", "what is missing before the vehicle can drive");
  command->add_option("DIR", arguments->site, "site folder")->required();
  add_device_options(*command, arguments->devices);
  command->add_flag("--no-devices", arguments->no_devices, "look at the folder alone");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace madori::app
