#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <thread>

#include "app/commands.hpp"
#include "app/cycle/site_config.hpp"
#include "app/lidars.hpp"
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

/// What a scanner surely sees against what the vehicle needs to stand.
std::string look_at_sight(const CycleConfig& config) {
  const double speed_mps = config.limits.max_speed_mps;
  const double needs_m = config.braking.horizon_m(speed_mps);
  char text[160];
  std::snprintf(text, sizeof text, "a leg of %.0f mm is sure to %.1f m; at %.1f m/s the vehicle needs %.1f m",
                kLegM * 1000.0, config.sure_range_m, speed_mps, needs_m);
  if (needs_m <= config.sure_range_m) return text;
  char mend[120];
  std::snprintf(mend, sizeof mend,
                "set max_speed_mps to %.2f (no faster is driven), or mount a lidar with a finer step",
                std::floor(100.0 * config.braking.speed_within(config.sure_range_m)) / 100.0);
  throw Error("site.yaml", text, mend);
}

std::string look_at_disk(const fs::path& site) {
  const auto free = fs::space(site).available;
  if (free < kRoomForRecordings)
    throw Error(site.string(), "has only " + std::to_string(free / 1'000'000) + " MB left for recordings",
                "free some disk space");
  return std::to_string(free / 1'000'000'000) + " GB left";
}

/// Listens for a moment: both devices speak by themselves.
std::string look_at_devices(const SocketOptions& devices, const SiteForDriving& loaded) {
  SocketLink link(devices, loaded.config.odometry.wheels, loaded.site.sensors);
  std::map<std::size_t, std::size_t> points;  // of a sweep, by lidar
  std::vector<control::wire::Status> drive;
  const std::size_t lidars = loaded.config.lidars.size();
  for (int i = 0; i < 30 && (drive.empty() || points.size() < lidars); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    CycleInput now;
    link.collect(now);
    if (!now.drive.empty()) drive = now.drive;
    for (const auto& cloud : now.clouds) points[cloud.lidar] = cloud.points.size();
    for (const auto& scan : now.scans) points[scan.lidar] = scan.ranges_m.size();
  }
  std::string text;
  const auto states = link.lidars();
  for (std::size_t i = 0; i < lidars; ++i) {
    const auto& row = sensors::lidar_of(states[i].sensor.type, states[i].sensor.name);
    if (!points.contains(i))
      throw Error("the " + row.title + " is silent",
                  "no revolution came on " + states[i].place + " in 3 s" +
                      (states[i].health.problem.empty() ? "" : " (" + states[i].health.problem + ")"),
                  "check its power, its cable, and that it sends to this computer");
    text += states[i].sensor.name + " (" + row.title + ") " + std::to_string(points[i]) +
            " points a revolution, ";
  }
  if (drive.empty())
    throw Error("the drive is silent", "no status came on " + devices.drive_device + " in 3 s",
                "check its power, its cable, and --drive");
  char battery[40];
  std::snprintf(battery, sizeof battery, "battery %.1f V", drive.back().battery_mv / 1000.0);
  return text + battery;
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
  if (loaded) checkup.check("sight", [&] { return look_at_sight(loaded->config); });
  checkup.check("orders", [&] {
    const OrderStore store(site / "madori.db");
    if (const auto verdict = store.integrity(); verdict != "ok")
      throw Error((site / "madori.db").string(), verdict, "restore a backup, or move the file away");
    return std::to_string(store.list(true).size()) + " open";
  });
  checkup.check("disk", [&] { return look_at_disk(site); });
  if (loaded && !arguments.no_devices)
    checkup.check("devices", [&] { return look_at_devices(arguments.devices, *loaded); });
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
