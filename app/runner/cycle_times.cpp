#include "app/runner/cycle_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "mapping/site/atomic_file.hpp"

namespace madori::app {
namespace {

double seconds(CycleTimes::Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

void TimeHistogram::add(double seconds) {
  const auto bound = std::ranges::lower_bound(kBounds_s, seconds);
  counts_[static_cast<std::size_t>(bound - kBounds_s.begin())].fetch_add(1, std::memory_order_relaxed);
  sum_s_.store(sum_s_.load(std::memory_order_relaxed) + seconds, std::memory_order_relaxed);
}

std::string TimeHistogram::prometheus(const std::string& name, const std::string& help) const {
  std::string text = fmt::format("# HELP {0} {1}\n# TYPE {0} histogram\n", name, help);
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    below += counts_[i].load(std::memory_order_relaxed);
    text += fmt::format("{}_bucket{{le=\"{}\"}} {}\n", name,
                        i < kBounds_s.size() ? fmt::format("{}", kBounds_s[i]) : "+Inf", below);
  }
  return text +
         fmt::format("{0}_sum {1}\n{0}_count {2}\n", name, sum_s_.load(std::memory_order_relaxed), below);
}

void CycleTimes::add(Clock::time_point due, Clock::time_point begun, Clock::time_point ended) {
  late_.add(std::max(0.0, seconds(begun - due)));
  step_.add(seconds(ended - begun));
  if (!keep_each_) return;
  if (steps_.empty()) first_ = due;
  steps_.push_back({static_cast<float>(seconds(due - first_)), static_cast<float>(1e3 * seconds(begun - due)),
                    static_cast<float>(1e3 * seconds(ended - begun))});
}

void CycleTimes::write(const std::filesystem::path& file) const {
  std::string text = "due_s,late_ms,step_ms\n";
  const double first_s = seconds(first_.time_since_epoch());
  for (const Step& step : steps_) {
    char line[96];
    const int size = std::snprintf(line, sizeof line, "%.3f,%.3f,%.3f\n",
                                   first_s + static_cast<double>(step.since_first_s),
                                   static_cast<double>(step.late_ms), static_cast<double>(step.step_ms));
    text.append(line, static_cast<std::size_t>(size));
  }
  mapping::write_file_atomically(file, text);
}

std::string CycleTimes::prometheus() const {
  return late_.prometheus("madori_cycle_late_seconds", "how much later than due a step of the cycle began") +
         step_.prometheus("madori_cycle_step_seconds", "how long a step of the cycle took");
}

}  // namespace madori::app
