#include "app/statistics/work_meter.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "core/clock.hpp"
#include "core/thread_role.hpp"

namespace madori::app {
namespace {

constexpr std::chrono::seconds kWriteEvery{5};
constexpr double kLongestStep_s = 1.0;
constexpr double kFarthestStep_m = 1.0;

/// Standing that an operator would want to know of: not while there is nothing to do.
bool counts(Mode mode) {
  return mode != Mode::Idle && mode != Mode::Manual && !drives(mode);
}

}  // namespace

WorkMeter::WorkMeter(const std::filesystem::path& database)
    : store_(database),
      written_(store_.sums()),
      since_(store_.since()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

WorkMeter::~WorkMeter() = default;

void WorkMeter::count(const CycleInput& input, const CycleState& state) {
  Step step{input.now, state.odometry.reading().odom_from_base, state.standstill.cause.code};
  const auto before = std::exchange(previous_, step);
  if (!before) return;
  const double passed_s = to_seconds(step.now - before->now);
  const double moved_m = distance_m(before->odom_from_base.translation(), step.odom_from_base.translation());
  if (!(passed_s > 0.0 && passed_s < kLongestStep_s && moved_m < kFarthestStep_m)) return;
  const std::scoped_lock lock(mutex_);
  now_ = time_of_day(input.now);
  waiting_.distance_m += moved_m;
  if (drives(state.mode)) waiting_.driving_s += passed_s;
  if (!counts(state.mode) || step.cause.empty()) return;
  waiting_.standing_s += passed_s;
  auto& stood = waiting_.causes[step.cause];
  stood.seconds += passed_s;
  if (step.cause != before->cause) ++stood.count;
}

Work WorkMeter::sums() const {
  const std::scoped_lock lock(mutex_);
  Work all = written_;
  all.add(waiting_);
  return all;
}

std::optional<Stamp> WorkMeter::since() const {
  const std::scoped_lock lock(mutex_);
  return since_;
}

void WorkMeter::write() {
  Work work;
  Stamp now;
  {
    const std::scoped_lock lock(mutex_);
    work = waiting_;
    now = now_;
  }
  if (now == Stamp{}) return;
  try {
    store_.add(work, now);
  } catch (const std::exception& e) {
    spdlog::warn("statistics are not written: {}", e.what());
    return;  // they wait for the next time
  }
  const std::scoped_lock lock(mutex_);
  if (!since_) since_ = now;
  written_.add(work);
  waiting_.distance_m -= work.distance_m;
  waiting_.driving_s -= work.driving_s;
  waiting_.standing_s -= work.standing_s;
  for (const auto& [cause, stood] : work.causes) {
    waiting_.causes[cause].count -= stood.count;
    waiting_.causes[cause].seconds -= stood.seconds;
  }
}

void WorkMeter::run(const std::stop_token& stop) {
  (void)take_role("work meter", ThreadRole::Behind);
  while (!stop.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, stop, kWriteEvery, [] { return false; });
    }
    write();
  }
}

}  // namespace madori::app
