#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <thread>

#include "app/commands.hpp"
#include "app/commands/doctor_mounting.hpp"
#include "app/runner/device_run.hpp"
#include "app/runner/device_search.hpp"
#include "app/runner/self_test.hpp"
#include "core/result.hpp"
#include "sensors/lidar/registry.hpp"

namespace madori::app {
namespace {

struct DoctorArguments {
  std::string site;
  SocketOptions devices;
  bool no_devices = false;
  bool find = false;
  MountingArguments mounting;
};

/// Listens for a moment: both devices speak by themselves.
std::string look_at_devices(const SocketOptions& devices, const SiteForDriving& loaded) {
  SocketLink link(devices, loaded.config.odometry.wheels, loaded.site.sensors);
  std::map<std::size_t, std::size_t> points;  // of a sweep, by lidar
  std::vector<control::wire::Status> drive;
  const std::size_t lidars = loaded.config.lidars.size();
  std::map<std::size_t, std::size_t> sweeps;
  double slowest_s = 0.0, listened_s = 0.0;
  for (const auto& lidar : loaded.config.lidars) slowest_s = std::max(slowest_s, lidar.period_s);
  const double most_s = 3.0 + 2.0 * slowest_s, least_s = 1.0 + slowest_s;
  while (listened_s < least_s || (listened_s < most_s && (drive.empty() || points.size() < lidars))) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    listened_s += 0.1;
    CycleInput now;
    link.collect(now);
    if (!now.drive.empty()) drive = now.drive;
    for (const auto& cloud : now.clouds) points[cloud.lidar] = cloud.points.size(), ++sweeps[cloud.lidar];
    for (const auto& scan : now.scans) points[scan.lidar] = scan.ranges_m.size(), ++sweeps[scan.lidar];
  }
  std::string text;
  const auto states = link.lidars();
  for (std::size_t i = 0; i < lidars; ++i) {
    const auto& row = sensors::lidar_of(states[i].sensor.type, states[i].sensor.name);
    if (!points.contains(i))
      throw Error("the " + row.title + " is silent",
                  "no sweep came on " + states[i].place +
                      (states[i].health.problem.empty() ? "" : " (" + states[i].health.problem + ")"),
                  "check its power, its cable, and that it sends to this computer");
    const auto& health = states[i].health;
    char line[160];
    std::snprintf(line, sizeof line, " points a sweep, %.1f sweeps a second, %llu lost, %llu refused; ",
                  static_cast<double>(sweeps[i]) / listened_s,
                  static_cast<unsigned long long>(health.counters.lost),
                  static_cast<unsigned long long>(health.counters.refused));
    text += states[i].sensor.name + " (" + row.title + " on " + states[i].place + ") " +
            std::to_string(points[i]) + line;
    if (!health.problem.empty()) text += health.problem + "; ";
  }
  if (drive.empty())
    throw Error("the drive is silent", "no status came on " + devices.drive_device + " in 3 s",
                "check its power, its cable, and --drive");
  char battery[40];
  std::snprintf(battery, sizeof battery, "battery %.1f V", drive.back().battery_mv / 1000.0);
  return text + battery;
}

/// Who answers where nobody listens yet.
void find(const std::string& folder, const SocketOptions& devices) {
  std::vector<mapping::SensorRecord> taken;
  if (std::filesystem::exists(std::filesystem::path(folder) / "site.yaml"))
    taken = addressed(mapping::load_site(folder).sensors, devices);
  const auto found = search_devices(taken, devices.drive_device);
  for (const auto& device : found)
    std::printf("found    %-10s %s%s\n", device.type.c_str(), device.address.c_str(),
                device.type == "drive" ? ", use it with --drive" : ", enter it below sensors: of site.yaml");
  if (found.empty()) std::puts("nobody answers but whom the site names");
}

void run(const DoctorArguments& arguments) {
  if (arguments.find) find(arguments.site, arguments.devices);
  if (arguments.mounting.wanted)
    return calibrate_mountings(arguments.site, arguments.devices, arguments.mounting);
  SelfTest test = look_at_site(arguments.site);
  if (test.site && !arguments.no_devices)
    test.findings.push_back(look("devices", [&] { return look_at_devices(arguments.devices, *test.site); }));
  for (const Finding& f : test.findings)
    std::printf("%-8s %-10s %s\n", f.missing ? "MISSING" : "ok", f.what.c_str(), f.text.c_str());
  if (const auto missing = std::ranges::count_if(test.findings, &Finding::missing); missing > 0)
    throw Error(arguments.site, std::to_string(missing) + " thing(s) missing", "see the lines above");
  std::puts("the vehicle is ready");
}

}  // namespace

void add_doctor(CLI::App& app) {
  auto arguments = std::make_shared<DoctorArguments>();
  CLI::App* command = app.add_subcommand("doctor", "what is missing before the vehicle can drive");
  command->add_option("DIR", arguments->site, "site folder")->required();
  add_device_options(*command, arguments->devices);
  command->add_flag("--no-devices", arguments->no_devices, "look at the folder alone");
  command->add_flag("--find", arguments->find,
                    "look for devices on the network and the serial ports that the site does not name");
  MountingArguments& mounting = arguments->mounting;
  auto* measure = command->add_flag("--calibrate-mounting", mounting.wanted,
                                    "measure how the lidars are mounted: the vehicle drives a metre forward, "
                                    "once around and back");
  command->add_option("--log", mounting.log, "measure it from a recorded run instead of driving")
      ->needs(measure);
  command->add_flag("--yes", mounting.yes, "a person has looked: drive at once")->needs(measure);
  command->add_flag("--apply", mounting.apply, "take what was found over into site.yaml")->needs(measure);
  command->add_option("--json", mounting.json_file, "what was measured as JSON, - for stdout")
      ->needs(measure);
  command->callback([arguments] { run(*arguments); });
}

}  // namespace madori::app
