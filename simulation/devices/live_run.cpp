#include "simulation/devices/live_run.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/thread_role.hpp"

namespace madori::simulation {
namespace {

using Clock = std::chrono::steady_clock;
constexpr Duration kStep = std::chrono::milliseconds(1);
constexpr int kStepsBetweenTruths = 10;
constexpr int kStepsBetweenMessages = 50;
constexpr double kMostLagS = 0.25;  ///< beyond it the schedule moves instead of racing after the clock

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

LiveReport run_live(Factory& factory, DeviceHub& hub, TruthServer& truth, const LiveOptions& options,
                    const std::atomic<bool>& stop, const std::function<void(const GroundTruth&)>& on_truth) {
  (void)take_role("virtual factory",
                  ThreadRole::Cycle);  // stands for devices that have computers of their own
  LiveReport report;
  const Clock::time_point start = Clock::now();
  const Stamp first = factory.now();
  for (std::int64_t step = 1; !stop; ++step) {
    if (options.duration_s > 0.0 && report.simulated_s >= options.duration_s) break;
    const double due_s = to_seconds(kStep) * static_cast<double>(step) / options.speed + report.lag_s;
    const double late_s = seconds_since(start) - due_s;
    if (late_s < 0.0)
      std::this_thread::sleep_for(std::chrono::duration<double>(-late_s));
    else if (late_s > kMostLagS)
      report.lag_s += late_s;
    if (const auto commands = hub.poll(); !commands.empty()) factory.drive_write(commands);
    factory.step(kStep);
    for (const DevicePacket& packet : factory.take_packets()) hub.send(packet);
    if (step % kStepsBetweenTruths == 0) on_truth(factory.truth());
    if (step % kStepsBetweenMessages == 0)
      truth.send(truth_json(factory.truth(), factory.collisions().size()));
    truth.poll();
    report.simulated_s = to_seconds(factory.now() - first);
  }
  (void)take_role("madori", ThreadRole::Ordinary);
  report.wall_s = seconds_since(start);
  return report;
}

}  // namespace madori::simulation
