#include "app/braking/braking_run.hpp"

#include <memory>
#include <utility>

#include "app/braking/braking_desk.hpp"
#include "app/runner/log_aside.hpp"
#include "app/runner/real_time.hpp"
#include "app/runner/site_lock.hpp"
#include "app/runner/site_run.hpp"
#include "core/clock.hpp"
#include "core/result.hpp"
#include "mapping/site/site_transaction.hpp"

namespace madori::app {
namespace {

/// One series of stops, when the devices have been heard for a moment.
void drive_series(SiteRun& vehicle, BrakingDesk& desk, const BrakingPlan& plan, bool loaded,
                  const std::atomic<bool>& interrupted) {
  constexpr double kHearS = 3.0;
  const Stamp begun = clock_now();
  bool started = false;
  const auto done = [&] {
    if (!started && to_seconds(clock_now() - begun) > kHearS) started = desk.start(plan, loaded);
    return started && !desk.view().running;
  };
  run_in_real_time([&](Stamp now) { vehicle.tick(now); }, interrupted,
                   {.done = done, .told = [&](const std::string& text) { vehicle.tell(text); }});
  if (interrupted) throw Error("the braking test", "was interrupted", "start it again");
  if (const Notice trouble = desk.view().trouble; !trouble.empty())
    throw Error("the braking test", trouble.text, "see to it, and start the test again");
}

}  // namespace

std::vector<BrakingStop> run_braking_test(const BrakingRunOptions& options,
                                          const std::atomic<bool>& interrupted) {
  const LogAside log;
  const SiteLock lock(options.site);
  const mapping::Site site = mapping::load_scaled_site(options.site);
  BrakingDesk desk;
  auto link = std::make_unique<SocketLink>(options.devices, WheelGeometry{}, site.sensors);
  SocketLink& devices = *link;
  SiteRun vehicle(
      options.site, std::move(link),
      {.opened =
           [&](TransportRun& run) {
             devices.set_wheels(run.config().odometry.wheels);
             run.set_tap([&desk, &run](const auto& input, const auto& /*output*/, const auto& state) {
               for (const auto& word : desk.after_step(input, state, run.config())) run.say(word);
             });
           },
       .closing = {},
       .idle = {}});
  vehicle.load_now();
  const BrakingPlan plan{options.speed_mps > 0.0 ? options.speed_mps : site.vehicle.max_speed_mps,
                         options.stops};
  drive_series(vehicle, desk, plan, false, interrupted);
  if (options.load && !options.load())
    throw Error("the braking test", "nobody said that the load is on",
                "load the vehicle, and start it again");
  if (options.load) drive_series(vehicle, desk, plan, true, interrupted);
  return desk.view().stops;
}

void take_over(const std::filesystem::path& folder, const BrakingVerdict& verdict, bool lower_speed) {
  mapping::Site site = mapping::load_site(folder);
  site.vehicle = with_measured(site.vehicle, verdict, lower_speed);
  mapping::SiteTransaction change(folder);
  change.write("site.yaml", mapping::site_yaml(site));
  change.commit();
}

}  // namespace madori::app
