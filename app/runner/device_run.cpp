#include "app/runner/device_run.hpp"

#include <spdlog/spdlog.h>

#include <future>
#include <memory>
#include <utility>

#include "app/learned/kept_memory.hpp"
#include "app/lidars.hpp"
#include "app/panel/panel.hpp"
#include "app/recording/recorder.hpp"
#include "app/runner/interruption.hpp"
#include "app/runner/log_aside.hpp"
#include "app/runner/real_time.hpp"
#include "app/runner/self_test.hpp"
#include "app/runner/site_lock.hpp"
#include "app/runner/site_run.hpp"
#include "app/runner/watchdog.hpp"
#include "core/clock.hpp"
#include "core/thread_role.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::app {
namespace {

/// The recording of each run, and the panel that looks on.
class Onlookers {
 public:
  explicit Onlookers(const DeviceRunOptions& options) : options_(options) {}

  /// `memory`: what the run begins with, without which it could not be replayed; empty: nothing.
  void begin(TransportRun& run, const std::string& memory, Panel* panel) {
    end();
    if (options_.record) {
      folder_ = new_run(options_.site / "runs");
      RecorderOptions recording;
      recording.lidars = run.config().lidars;
      recorder_ = std::make_unique<Recorder>(folder_, recording);
      keep_beginning(memory);
    }
    if (panel != nullptr) panel->begin_run();
    run.set_tap([this, panel, &run](const auto& in, const auto& out, const auto& state) {
      if (recorder_) recorder_->add(in, out, state);
      if (panel != nullptr) panel->observe(in, state, run);
    });
    if (options_.resume && !std::exchange(resumed_, true)) {
      run.say({OperatorWord::Confirm, {}});
      run.say({OperatorWord::Resume, {}});
    }
  }
  void end() {
    if (recorder_ && recorder_->lost() > 0)
      spdlog::warn("{} steps are missing in the recording {}", recorder_->lost(), recorder_->problem());
    recorder_.reset();
  }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  /// A full disk is no reason not to drive.
  void keep_beginning(const std::string& memory) const {
    if (memory.empty()) return;
    try {
      std::filesystem::create_directories(folder_);
      mapping::write_file_atomically(folder_ / kMemoryFile, memory);
    } catch (const std::exception& e) {
      spdlog::warn("the recording cannot be replayed: {}", e.what());
    }
  }

  const DeviceRunOptions& options_;
  std::filesystem::path folder_;
  std::unique_ptr<Recorder> recorder_;
  bool resumed_ = false;
};

}  // namespace

std::filesystem::path run_on_devices(const DeviceRunOptions& options) {
  // First of all: who is asked to end while it still reads the site ends in order, too.
  const std::atomic<bool>& interrupted = interrupted_by({SIGINT, SIGTERM, SIGHUP});
  const LogAside log;
  const SiteLock lock(options.site);
  Onlookers onlookers(options);
  Panel* looking_on = nullptr;
  auto link = std::make_unique<SocketLink>(options.devices, WheelGeometry{}, listed_sensors(options.site));
  SocketLink& devices = *link;
  SiteRun vehicle(options.site, std::move(link),
                  {.opened =
                       [&](TransportRun& run) {
                         devices.set_wheels(run.config().odometry.wheels);
                         devices.set_sensors(vehicle.sensors_begun_with());
                         onlookers.begin(run, vehicle.memory_begun_with(), looking_on);
                       },
                   .closing = [&] { onlookers.end(); },
                   .idle =
                       [&](const CycleInput& input) {
                         if (looking_on != nullptr) looking_on->idle(input);
                       },
                   .looked =
                       [&](const std::vector<mapping::SensorRecord>& sensors) {
                         try {
                           devices.set_sensors(sensors);
                         } catch (const std::exception& e) {  // a port is taken: said, and the rest goes on
                           spdlog::warn("{}", e.what());
                         }
                       }});
  CycleTimes times(!options.cycle_times.empty());
  const auto panel = open_panel(vehicle, {options.site, options.hmi, options.panel_folder, options.devices,
                                          options.camera, [&] { return times.prometheus(); }});
  looking_on = panel.get();
  if (panel)
    spdlog::info("panel at {}", panel->address());
  else
    vehicle.load_now();  // nobody could complete the site
  // Beside: it reads every file of the site.
  const auto self_test = std::async(std::launch::async, [site = options.site] {
    (void)take_role("self-test", ThreadRole::Behind);
    for (const Finding& f : look_at_site(site).findings)
      spdlog::log(f.missing ? spdlog::level::warn : spdlog::level::info, "self-test: {} {}: {}", f.what,
                  f.missing ? "is MISSING" : "ok", f.text);
  });
  const Stamp begun = clock_now();
  Watchdog watchdog({.told = [](const std::string& text) { spdlog::critical("{}", text); }});
  run_in_real_time(
      [&](Stamp now) { vehicle.tick(now); }, interrupted,
      {.done =
           [&] { return options.duration_s > 0.0 && to_seconds(clock_now() - begun) > options.duration_s; },
       .told = [&](const std::string& text) { vehicle.tell(text); },
       .placed =
           [&](bool first) {
             if (first)
               spdlog::info("the cycle comes before ordinary work; memory is {}",
                            lock_memory() ? "kept from swapping" : "not kept from swapping");
             else
               spdlog::warn(
                   "other programs can hold the cycle up: this user may not set real-time priorities "
                   "- see docs/how-to/drive.md");
           },
       .came_round = [&] { watchdog.beat(); },
       .times = &times});
  if (!options.cycle_times.empty()) times.write(options.cycle_times);
  return onlookers.folder();
}

}  // namespace madori::app
