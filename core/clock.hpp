#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include "core/stamp.hpp"

namespace madori {

/// One of the computer's clocks moved against the other.
struct ClockJump {
  enum class Kind {
    MonotonicBack,  ///< what never may go back went back; the program's time did not
    TimeOfDaySet,   ///< somebody set the time of day: an operator, NTP, a time zone script
    TimeOfDayRuns   ///< the time of day runs at another speed: NTP that slews, a bad quartz
  };
  Kind kind = Kind::TimeOfDaySet;
  Duration by{};  ///< positive: forward
};

/// The program's one clock. Its time is monotonic time, counted from the time of day at its start: the stamps
/// of one run look like times of day and never step. What the time of day does afterwards is a label alone,
/// for people and for other programs. Safe from every thread.
class Clock {
 public:
  /// Two clocks of the computer, each since an origin of its own.
  struct Source {
    std::function<Duration()> monotonic;
    std::function<Duration()> time_of_day;
  };

  explicit Clock(Source source)
      : source_(std::move(source)),
        start_(source_.time_of_day()),
        monotonic_start_(source_.monotonic()),
        monotonic_(monotonic_start_) {}

  /// Never before an earlier one.
  [[nodiscard]] Stamp now() {
    const std::scoped_lock lock(mutex_);
    return read();
  }

  /// The time of day at a moment of this clock, as far as watch() has followed it.
  [[nodiscard]] Stamp label(Stamp moment) {
    const std::scoped_lock lock(mutex_);
    return moment + label_;
  }

  /// What the computer's clocks did against each other since the last call. Call it often: a slow change that
  /// comes in one piece counts as a step.
  [[nodiscard]] std::vector<ClockJump> watch() {
    constexpr Duration kStep = std::chrono::milliseconds(50);  // NTP slews at most 0.5 ms a second
    constexpr Duration kRuns = std::chrono::seconds(1);
    constexpr Duration kInterrupted = std::chrono::milliseconds(5);
    const std::scoped_lock lock(mutex_);
    std::vector<ClockJump> jumps;
    const Stamp before = read();
    const Duration time_of_day = source_.time_of_day();
    const bool torn = read() - before > kInterrupted;  // the two were not read together
    if (back_ > Duration(0)) jumps.push_back({ClockJump::Kind::MonotonicBack, -std::exchange(back_, {})});
    if (torn) return jumps;
    const Duration offset = time_of_day - before.time_since_epoch();
    const Duration step = offset - std::exchange(offset_, offset);
    const bool stepped = step > kStep || step < -kStep;
    const Duration run = offset - label_;
    if (stepped)
      jumps.push_back({ClockJump::Kind::TimeOfDaySet, step});
    else if (run > kRuns || run < -kRuns)
      jumps.push_back({ClockJump::Kind::TimeOfDayRuns, run});
    else
      return jumps;
    label_ = offset;
    return jumps;
  }

 private:
  Stamp read() {
    const Duration monotonic = source_.monotonic();
    if (monotonic < monotonic_) back_ += monotonic_ - monotonic, held_ += monotonic_ - monotonic;
    monotonic_ = monotonic;
    return Stamp(start_ + (monotonic - monotonic_start_) + held_);
  }

  std::mutex mutex_;
  Source source_;
  Duration start_;
  Duration monotonic_start_;
  Duration monotonic_;  ///< as it was read last
  Duration held_{};     ///< what it went back, all in all
  Duration back_{};     ///< of that, what nobody was told yet
  Duration offset_{};   ///< of the time of day from this clock, at the last watch()
  Duration label_{};    ///< the same, as people were told it
};

/// The computer's clock. The only place that reads the time of day; unit_house looks for others.
[[nodiscard]] inline Clock& computer_clock() {
  static Clock clock({[] { return Duration(std::chrono::steady_clock::now().time_since_epoch()); },
                      [] { return Duration(std::chrono::system_clock::now().time_since_epoch()); }});
  return clock;
}

/// The moment, for everything that is compared with another moment.
[[nodiscard]] inline Stamp clock_now() {
  return computer_clock().now();
}

/// A moment as a label: what people and other programs read.
[[nodiscard]] inline Stamp time_of_day(Stamp moment) {
  return computer_clock().label(moment);
}
[[nodiscard]] inline Stamp time_of_day() {
  return time_of_day(clock_now());
}

}  // namespace madori
