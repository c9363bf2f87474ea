#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands.hpp"
#include "app/cycle/site_config.hpp"
#include "app/iso_time.hpp"
#include "app/pose/drawing_pose.hpp"
#include "app/recording/recorder.hpp"
#include "app/runner/real_time.hpp"
#include "app/runner/socket_link.hpp"

namespace madori::app {
namespace {

std::atomic<bool> interrupted = false;  // NOLINT: a signal handler reaches nothing else

struct RunArguments {
  std::string site;
  SocketOptions devices;
  bool resume = false;
  bool record = true;
};

/// The name of a run's folder: the time at which it began.
std::string run_name() {
  std::string name = iso_time_utc();
  for (char& c : name)
    if (c == ':') c = '-';
  return name;
}

void run(const RunArguments& arguments) {
  auto loaded = load_for_driving(arguments.site);
  const auto wheels = loaded.config.odometry.wheels;
  TransportRun vehicle(std::move(loaded.config), std::make_unique<DrawingPose>(loaded.walls),
                       std::make_unique<SocketLink>(arguments.devices, wheels), {.site = arguments.site});
  std::unique_ptr<Recorder> recorder;
  if (arguments.record) {
    recorder = std::make_unique<Recorder>(std::filesystem::path(arguments.site) / "runs" / run_name());
    vehicle.set_tap(
        [&](const auto& in, const auto& out, const auto& state) { recorder->add(in, out, state); });
  }
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  std::puts("Madori is not a safety device: keep a certified scanner and an emergency stop on the drive.");
  if (arguments.resume) {
    vehicle.say({OperatorWord::Confirm, {}});
    vehicle.say({OperatorWord::Resume, {}});
  } else {
    std::puts("the vehicle is paused; start with --resume to let it drive");
  }
  run_in_real_time(vehicle, interrupted);
  if (recorder && recorder->lost() > 0)
    std::fprintf(stderr, "%llu steps are missing in the recording %s\n",
                 static_cast<unsigned long long>(recorder->lost()), recorder->problem().c_str());
}

}  // namespace

void add_run(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "drive the vehicle of a site");
  command->add_option("DIR", arguments->site, "site folder")->required();
  command->add_option("--lidar", arguments->devices.lidar_address, "address to receive the VLP-16 on")
      ->capture_default_str();
  command->add_option("--lidar-port", arguments->devices.lidar_port, "its UDP port")->capture_default_str();
  command
      ->add_option("--position-port", arguments->devices.lidar_position_port,
                   "UDP port of its position packets")
      ->capture_default_str();
  command->add_option("--drive", arguments->devices.drive_device, "serial port of the drive")
      ->capture_default_str();
  command->add_option("--scanner", arguments->devices.safety_scanner,
                      "serial port of an S300 safety scanner");
  command->add_flag("--resume", arguments->resume, "the operator has looked around: drive at once");
  command->add_flag("!--no-record", arguments->record, "do not record the run below DIR/runs");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace madori::app
