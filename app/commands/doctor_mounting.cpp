#include "app/commands/doctor_mounting.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/cycle/site_config.hpp"
#include "app/json_output.hpp"
#include "app/lidars.hpp"
#include "app/mounting/mounting_run.hpp"
#include "app/recording/replay.hpp"
#include "app/runner/interruption.hpp"
#include "app/runner/real_time.hpp"
#include "app/runner/site_lock.hpp"
#include "core/angle.hpp"
#include "core/result.hpp"
#include "mapping/site/site_transaction.hpp"

namespace madori::app {
namespace {

using State = MountingView::State;

struct Measured {
  localization::MountingCalibration found;
  std::vector<MountingFinding> findings;
};

Measured from_log(const std::string& run, const mapping::Site& site, const CycleConfig& vehicle) {
  MountingLog log(vehicle.odometry.wheels);
  look_at_inputs(run, vehicle, [&](const CycleInput& input) { log.add(input); });
  Measured measured;
  measured.found = localization::calibrate_mounting(log.drive(), vehicle.lidars, vehicle.odometry.wheels);
  measured.findings = mounting_findings(measured.found, site.sensors);
  return measured;
}

/// Nothing moves before a person has looked.
void ask_person() {
  std::fputs(
      "The vehicle drives a metre forward, turns once around and drives back, slowly; the lidars watch, "
      "laid\n"
      "by the mountings as typed. Keep a metre free before it and the space to turn, and a hand at the\n"
      "emergency stop.\n"
      "Type yes to begin: ",
      stderr);
  std::string answer;
  if (!std::getline(std::cin, answer) || answer != "yes")
    throw Error("doctor", "nothing was measured", "type yes, or give --yes");
}

Measured from_drive(const std::string& folder, const mapping::Site& site, const WheelGeometry& wheels,
                    const SocketOptions& devices) {
  const SiteLock lock(folder);
  SocketLink link(devices, wheels, site.sensors);
  MountingRun run(site.vehicle, site.sensors);
  const std::atomic<bool>& interrupted = interrupted_by({SIGINT});
  std::atomic<bool> never = false;
  int told = -1;
  const auto over = [&] { return run.view().state == State::Done || run.view().state == State::Stopped; };
  run_in_real_time(
      [&](Stamp now) {
        CycleInput input;
        input.now = now;
        link.collect(input);
        if (interrupted) run.stop();
        link.send(run.tick(input));
        const int tenths = static_cast<int>(10.0 * run.view().progress);
        if (tenths > told) std::fprintf(stderr, "%d %% driven\n", 10 * (told = tenths));
      },
      never,
      {.done = over, .told = [](const std::string& text) { std::fprintf(stderr, "%s\n", text.c_str()); }});
  const MountingView view = run.view();
  if (view.state == State::Stopped) throw Error("the measurement was given up", view.notice.text, "");
  return {view.found, view.findings};
}

nlohmann::json json_of(const Measured& measured) {
  nlohmann::json lidars = nlohmann::json::array();
  const auto pose = [](const mapping::SensorRecord& s) {
    return nlohmann::json{{"x_m", s.x_m}, {"y_m", s.y_m}, {"z_m", s.z_m}, {"yaw_deg", s.yaw_deg}};
  };
  for (const auto& f : measured.findings)
    lidars.push_back({{"name", f.typed.name},
                      {"type", f.typed.type},
                      {"known", known_word(f.measured.known)},
                      {"height_known", f.measured.floor.has_value()},
                      {"typed", pose(f.typed)},
                      {"found", pose(f.found)},
                      {"sigma_m", {f.measured.sigma[0], f.measured.sigma[1]}},
                      {"sigma_deg", to_deg(f.measured.sigma[2])},
                      {"residual_m", f.measured.residual_m},
                      {"tilt_deg", f.tilt_deg()},
                      {"sweeps", f.measured.sweeps},
                      {"walls", f.measured.walls},
                      {"lack", f.lack.text}});
  nlohmann::json agreements = nlohmann::json::array();
  for (const auto& a : measured.found.agreements)
    agreements.push_back({{"first", measured.findings[a.first].typed.name},
                          {"second", measured.findings[a.second].typed.name},
                          {"apart_m", a.apart_m},
                          {"walls", a.walls}});
  nlohmann::json wheels;  // null where nothing tells them
  if (const auto& w = measured.found.wheels)
    wheels = {{"left_radius_m", w->geometry.left_radius_m},
              {"right_radius_m", w->geometry.right_radius_m},
              {"half_separation_m", w->geometry.half_separation_m},
              {"sigma_percent", {100.0 * w->sigma[0], 100.0 * w->sigma[1], 100.0 * w->sigma[2]}}};
  return {{"lidars", lidars},
          {"agreements", agreements},
          {"turned_deg", to_deg(measured.found.turned_rad)},
          {"driven_m", measured.found.driven_m},
          {"wheels", wheels}};
}

/// Takes over what was found; addresses and settings stay.
void apply(const std::string& folder, const std::vector<MountingFinding>& findings) {
  const SiteLock lock(folder, SiteUse::Change);
  mapping::SiteTransaction change(folder);
  mapping::Site site = mapping::load_site(folder);
  for (std::size_t i = 0; i < site.sensors.size() && i < findings.size(); ++i) {
    const auto& found = findings[i].found;
    auto& sensor = site.sensors[i];
    sensor.x_m = found.x_m, sensor.y_m = found.y_m, sensor.z_m = found.z_m, sensor.yaw_deg = found.yaw_deg;
  }
  (void)lidars_of(site, folder);
  change.write("site.yaml", mapping::site_yaml(site));
  change.commit();
}

}  // namespace

void calibrate_mountings(const std::string& folder, const SocketOptions& devices,
                         const MountingArguments& arguments) {
  expect_json(arguments.json_file);
  const mapping::Site site = mapping::load_site(folder);
  const CycleConfig vehicle = vehicle_config(site.vehicle, lidars_of(site, folder));
  if (arguments.log.empty() && !arguments.yes) ask_person();
  const Measured measured = arguments.log.empty() ? from_drive(folder, site, vehicle.odometry.wheels, devices)
                                                  : from_log(arguments.log, site, vehicle);
  if (arguments.json_file != "-")
    std::fputs(mounting_text(measured.found, measured.findings).c_str(), stdout);
  write_json(arguments.json_file, json_of(measured));
  if (std::ranges::all_of(measured.findings, [](const MountingFinding& f) {
        return f.measured.known == localization::MountingKnown::Nothing && !f.measured.floor;
      }))
    throw Error(folder, "no mounting was found", "see the lines above");
  if (arguments.apply) {
    apply(folder, measured.findings);
    if (arguments.json_file != "-") std::puts("taken over into site.yaml");
  }
}

}  // namespace madori::app
