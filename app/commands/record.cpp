#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/runner/device_run.hpp"

namespace madori::app {

void add_record(CLI::App& app) {
  auto options = std::make_shared<DeviceRunOptions>();
  CLI::App* command = app.add_subcommand("record", "record the vehicle's devices without driving");
  command->add_option("DIR", options->site, "site folder; the bags go below DIR/runs")->required();
  add_device_options(*command, options->devices);
  command->add_option("--duration", options->duration_s, "seconds; 0: until interrupted")
      ->check(within(0.0, 1e6))
      ->capture_default_str();
  command->callback([options] {
    const auto folder = run_on_devices(*options);
    std::printf("recorded in %s\n", folder.c_str());
  });
}

}  // namespace madori::app
