#include "app/runner/device_run.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>

#include "app/cycle/site_config.hpp"
#include "app/iso_time.hpp"
#include "app/panel/panel.hpp"
#include "app/pose/drawing_pose.hpp"
#include "app/recording/recorder.hpp"
#include "app/runner/real_time.hpp"

namespace madori::app {
namespace {

std::atomic<bool> interrupted = false;  // NOLINT: a signal handler reaches nothing else

/// The name of a run's folder: the time at which it began, without colons.
std::string run_name() {
  std::string name = iso_time_utc();
  std::replace(name.begin(), name.end(), ':', '-');
  return name;
}

}  // namespace

std::filesystem::path run_on_devices(const DeviceRunOptions& options) {
  auto loaded = load_for_driving(options.site);
  const auto wheels = loaded.config.odometry.wheels;
  TransportRun vehicle(std::move(loaded.config), std::make_unique<DrawingPose>(loaded.walls),
                       std::make_unique<SocketLink>(options.devices, wheels), {.site = options.site});
  std::filesystem::path folder;
  std::unique_ptr<Recorder> recorder;
  if (options.record) {
    folder = options.site / "runs" / run_name();
    recorder = std::make_unique<Recorder>(folder);
  }
  const auto panel = open_panel(vehicle, options.site, options.hmi, options.panel_folder);
  if (panel) spdlog::info("panel at {}", panel->address());
  vehicle.set_tap([&](const auto& in, const auto& out, const auto& state) {
    if (recorder) recorder->add(in, out, state);
    if (panel) panel->observe(in, state);
  });
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  if (options.resume) {
    vehicle.say({OperatorWord::Confirm, {}});
    vehicle.say({OperatorWord::Resume, {}});
  }
  const auto begun = std::chrono::steady_clock::now();
  run_in_real_time(vehicle, interrupted, [&] {
    return options.duration_s > 0.0 &&
           std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count() >
               options.duration_s;
  });
  if (recorder && recorder->lost() > 0)
    spdlog::warn("{} steps are missing in the recording {}", recorder->lost(), recorder->problem());
  return folder;
}

}  // namespace madori::app
