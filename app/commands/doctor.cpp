#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <thread>

#include "app/commands.hpp"
#include "app/lidars.hpp"
#include "app/runner/device_run.hpp"
#include "app/runner/self_test.hpp"
#include "core/result.hpp"

namespace madori::app {
namespace {

struct DoctorArguments {
  std::string site;
  SocketOptions devices;
  bool no_devices = false;
};

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
  command->callback([arguments] { run(*arguments); });
}

}  // namespace madori::app
