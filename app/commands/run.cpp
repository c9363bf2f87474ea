#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "app/runner/device_run.hpp"

namespace madori::app {

void add_device_options(CLI::App& command, SocketOptions& devices) {
  command.add_option("--lidar", devices.lidar_address, "address to receive the lidar on that sends by UDP")
      ->capture_default_str();
  command.add_option("--lidar-port", devices.lidar_port, "its UDP port")->capture_default_str();
  command.add_option("--position-port", devices.lidar_position_port, "UDP port of its position packets")
      ->capture_default_str();
  command.add_option("--drive", devices.drive_device, "serial port of the drive")->capture_default_str();
  command.add_option("--scanner", devices.safety_scanner, "serial port of the safety scanner");
  command.add_option("--scanner-baud", devices.scanner_baud, "its baud rate (default: what the site says)");
  command.add_option("--lms", devices.network_scanner, "HOST[:PORT] of the lidar that is called by TCP");
  command.add_option("--sensor", devices.addresses,
                     "NAME=ADDRESS: where a sensor of the site is found (HOST:PORT or serial port)");
}

void add_run(CLI::App& app) {
  auto options = std::make_shared<DeviceRunOptions>();
  CLI::App* command = app.add_subcommand("run", "drive the vehicle of a site");
  command->add_option("DIR", options->site, "site folder")->required();
  add_device_options(*command, options->devices);
  options->hmi = "127.0.0.1:8080";
  options->panel_folder = MADORI_PANEL_DIR;
  command->add_option("--hmi", options->hmi, "HOST:PORT of the touch panel; \"off\" for none")
      ->capture_default_str();
  command->add_option("--panel-folder", options->panel_folder, "where the built page lies");
  command->add_option("--camera", options->camera,
                      "URL or device of the verification camera (default: what site.yaml names)");
  command->add_flag("--resume", options->resume, "the operator has looked around: drive at once");
  command->add_flag("!--no-record", options->record, "do not record the run below DIR/runs");
  command->add_option("--cycle-times", options->cycle_times,
                      "CSV file for what each step of the cycle took, written at the end");
  command->callback([options] {
    std::puts("Madori is not a safety device: keep a certified scanner and an emergency stop on the drive.");
    if (!options->resume)
      std::puts("The vehicle is paused and stays so; press Resume on the panel, or start with --resume.");
    run_on_devices(*options);
  });
}

}  // namespace madori::app
