#include "app/runner/cycle_times.hpp"

#include <cstdio>
#include <string>

#include "mapping/site/atomic_file.hpp"

namespace madori::app {
namespace {

double seconds(CycleTimes::Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

void CycleTimes::add(Clock::time_point due, Clock::time_point begun, Clock::time_point ended) {
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

}  // namespace madori::app
