#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/json_output.hpp"
#include "app/runner/interruption.hpp"
#include "app/simulated/camera_stream.hpp"
#include "app/simulated/jpeg.hpp"
#include "app/trajectory_file.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"
#include "simulation/devices/live_run.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

struct SimArguments {
  std::string site, scenario, devices, truth_file, json_file;
  simulation::LiveOptions live;
  simulation::DeviceHubOptions hub;
  std::uint16_t truth_port = 0;
  std::optional<std::uint16_t> camera_port;
  std::optional<std::uint64_t> seed;
};

simulation::FactorySetup setup_of(const SimArguments& arguments) {
  const fs::path own = fs::path(arguments.site) / "scenario.yaml";
  if (arguments.scenario.empty() && !fs::exists(own))
    throw Error(own.string(), "there is no such file",
                "name a scenario: --scenario data/scenarios/empty.yaml");
  auto setup =
      simulation::load_setup(arguments.site, arguments.scenario.empty() ? own : fs::path(arguments.scenario));
  if (arguments.seed) setup.seed = setup.scenario.seed = *arguments.seed;
  setup.epoch = clock_now();
  return setup;
}

void print_devices(std::FILE* out, const simulation::Factory& factory, const simulation::DeviceHub& hub,
                   std::uint16_t truth_port) {
  const auto addresses = hub.addresses();
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    const auto& sensor = factory.sensors()[i];
    const auto cola = sensor.settings.find("cola");
    const std::string dialect = cola == sensor.settings.end() ? "" : " (CoLa " + cola->second + ")";
    const char* link = sensor.type == "vlp16" ? "udp" : sensor.type == "s300" ? "pty" : "tcp";
    if (!addresses[i].empty())
      std::fprintf(out, "%-6s %-4s %s%s\n", sensor.type.c_str(), link, addresses[i].c_str(), dialect.c_str());
  }
  std::fprintf(out, "drive  pty  %s\n", hub.drive_link().c_str());
  std::fprintf(out, "truth  ws   ws://127.0.0.1:%u\n", truth_port);
  std::fflush(out);
}

nlohmann::json summary(const simulation::Factory& factory, const simulation::LiveReport& report,
                       const simulation::HubCounters& sent) {
  nlohmann::json collisions = nlohmann::json::array();
  for (const auto& c : factory.collisions())
    collisions.push_back({{"time_s", to_seconds(c.stamp)},
                          {"what", c.what},
                          {"speed_mps", c.speed_mps},
                          {"x_m", c.map_from_base.x_m()},
                          {"y_m", c.map_from_base.y_m()}});
  return {{"simulated_s", report.simulated_s},
          {"wall_s", report.wall_s},
          {"lag_s", report.lag_s},
          {"distance_m", factory.distance_driven_m()},
          {"vlp16_packets", sent.vlp16_packets},
          {"vlp16_refused", sent.vlp16_refused},
          {"lms1xx_telegrams", sent.lms_telegrams},
          {"s300_telegrams", sent.s300_telegrams},
          {"drive_frames", sent.drive_frames},
          {"drive_bytes_received", sent.drive_bytes_received},
          {"collisions", collisions}};
}

void print_summary(const nlohmann::json& s) {
  std::printf("%.1f s simulated in %.1f s, %.2f m driven, %zu collisions\n", s["simulated_s"].get<double>(),
              s["wall_s"].get<double>(), s["distance_m"].get<double>(), s["collisions"].size());
  for (const auto& c : s["collisions"])
    std::printf("  with %s at %.2f m/s at (%.2f, %.2f)\n", c["what"].get<std::string>().c_str(),
                c["speed_mps"].get<double>(), c["x_m"].get<double>(), c["y_m"].get<double>());
  if (s["lag_s"].get<double>() > 0.0)
    std::printf("this machine could not keep up: %.1f s were given up\n", s["lag_s"].get<double>());
}

void simulate(SimArguments arguments) {
  const simulation::FactorySetup setup = setup_of(arguments);
  const fs::path folder =
      arguments.devices.empty() ? fs::path(arguments.site) / "devices" : fs::path(arguments.devices);
  expect_json(arguments.json_file, folder);
  fs::create_directories(folder);
  arguments.hub.folder = folder;
  if (arguments.live.duration_s <= 0.0) arguments.live.duration_s = setup.scenario.duration_s;
  simulation::Factory factory(setup);
  arguments.hub.sensors = factory.sensors();
  simulation::DeviceHub hub(arguments.hub);
  simulation::TruthServer truth(arguments.truth_port);
  std::ofstream tum;
  if (!arguments.truth_file.empty()) {
    tum.open(arguments.truth_file);
    if (!tum) throw Error(arguments.truth_file, "cannot be written", "check the path and its permissions");
    tum << kTumHead;
  }
  std::optional<CameraStream> camera;
  if (arguments.camera_port)
    camera.emplace(*arguments.camera_port, [&factory] { return to_jpeg(simulation::take_picture(factory)); });
  std::FILE* out = arguments.json_file == "-" ? stderr : stdout;  // stdout then holds the summary alone
  if (camera) std::fprintf(out, "camera http %s\n", camera->url().c_str());
  print_devices(out, factory, hub, truth.port());
  const std::atomic<bool>& interrupted = interrupted_by({SIGINT, SIGTERM});
  const auto report =
      run_live(factory, hub, truth, arguments.live, interrupted, [&](const simulation::GroundTruth& t) {
        if (tum.is_open()) tum << tum_line(t.stamp, t.map_from_base);
        if (camera) camera->poll();
      });
  const nlohmann::json result = summary(factory, report, hub.counters());
  if (arguments.json_file != "-") print_summary(result);
  write_json(arguments.json_file, result);
  if (tum.is_open() && !tum.flush())
    throw Error(arguments.truth_file, "could not be written to its end", "make room on the disk");
}

}  // namespace

void add_sim(CLI::App& app) {
  auto arguments = std::make_shared<SimArguments>();
  auto* sim = app.add_subcommand("sim", "run a virtual factory whose devices speak on real sockets");
  sim->add_option("site", arguments->site, "site folder")->required();
  sim->add_option("--scenario", arguments->scenario, "scenario file (default: scenario.yaml of the site)");
  sim->add_option("--speed", arguments->live.speed, "simulated seconds a second")
      ->check(within(0.01, 1000.0));
  sim->add_option("--duration", arguments->live.duration_s, "simulated seconds, then stop")
      ->check(within(0.0, 1e7));
  sim->add_option("--truth", arguments->truth_file, "write the ground truth as TUM");
  sim->add_option("--truth-port", arguments->truth_port, "WebSocket port of the ground truth (0: any)");
  sim->add_option("--camera-port", arguments->camera_port,
                  "serve a camera at the vehicle's front as Motion JPEG on this port (0: any)");
  sim->add_option("--lidar-port", arguments->hub.vlp16_port, "UDP port that the VLP-16 sends to")
      ->check(within(1, 65535));
  sim->add_option("--lms-port", arguments->hub.lms_port, "TCP port of the LMS1xx (0: any)");
  sim->add_option("--devices", arguments->devices, "folder for the serial ports (default: SITE/devices)");
  sim->add_option("--seed", arguments->seed, "instead of the scenario's");
  sim->add_option("--json", arguments->json_file, "summary as JSON; - is stdout");
  sim->callback([arguments] { simulate(*arguments); });
}

}  // namespace madori::app
