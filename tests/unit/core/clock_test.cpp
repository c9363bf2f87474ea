#include "core/clock.hpp"

#include <gtest/gtest.h>

#include <random>

namespace madori {
namespace {

using namespace std::chrono_literals;
using Kind = ClockJump::Kind;

/// Two clocks that a test sets.
struct Computer {
  Duration monotonic = 1000s;
  Duration day = std::chrono::hours(500'000);
  Clock clock{{[this] { return monotonic; }, [this] { return day; }}};

  void pass(Duration time) { monotonic += time, day += time; }
};

TEST(Clock, TimeIsCountedFromTheTimeOfDayAtTheStart) {
  Computer computer;
  EXPECT_EQ(computer.clock.now(), Stamp(std::chrono::hours(500'000)));
  computer.pass(3s);
  EXPECT_EQ(computer.clock.now(), Stamp(std::chrono::hours(500'000) + 3s));
}

TEST(Clock, ASetTimeOfDayMovesLabelsAlone) {
  for (const Duration step : {Duration(3600s), Duration(-3600s), Duration(70ms), Duration(-70ms)}) {
    Computer computer;
    (void)computer.clock.watch();
    computer.pass(20ms);
    computer.day += step;
    const Stamp now = computer.clock.now();
    EXPECT_EQ(now, Stamp(std::chrono::hours(500'000) + 20ms));
    EXPECT_EQ(computer.clock.label(now), now) << "nobody was told yet";
    const auto jumps = computer.clock.watch();
    ASSERT_EQ(jumps.size(), 1U);
    EXPECT_EQ(jumps[0].kind, Kind::TimeOfDaySet);
    EXPECT_EQ(jumps[0].by, step);
    EXPECT_EQ(computer.clock.now(), now);
    EXPECT_EQ(computer.clock.label(now).time_since_epoch(), computer.day);
    EXPECT_TRUE(computer.clock.watch().empty());
  }
}

TEST(Clock, AMonotonicClockThatGoesBackIsHeld) {
  Computer computer;
  const Stamp before = computer.clock.now();
  computer.monotonic -= 3600s;
  EXPECT_EQ(computer.clock.now(), before);
  computer.pass(20ms);
  EXPECT_EQ(computer.clock.now(), before + 20ms) << "it goes on at once";
  const auto jumps = computer.clock.watch();
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_EQ(jumps[0].kind, Kind::MonotonicBack);
  EXPECT_EQ(jumps[0].by, Duration(-3600s));
}

TEST(Clock, ATimeOfDayThatRunsIsToldOnceASecond) {
  Computer computer;
  std::vector<ClockJump> told;
  for (int tick = 0; tick < 50 * 60; ++tick) {  // 5 % fast for a minute: 3 s
    computer.pass(20ms);
    computer.day += 1ms;
    for (const auto& jump : computer.clock.watch()) told.push_back(jump);
  }
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].kind, Kind::TimeOfDayRuns);
  EXPECT_NEAR(to_seconds(told[1].by), 1.0, 0.01);
}

/// Whatever the computer's clocks do, the program's time never goes back, and passes as long as the monotonic
/// clock goes forward.
TEST(Clock, NeverGoesBackUnderAnySteps) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> what(0, 9);
  std::uniform_int_distribution<std::int64_t> far_ns(-10'000'000'000, 10'000'000'000);
  Computer computer;
  Stamp before = computer.clock.now();
  for (int i = 0; i < 20'000; ++i) {
    const Stamp expected = before + 20ms;
    computer.pass(20ms);
    const int event = what(random);
    if (event == 0) computer.day += Duration(far_ns(random));
    if (event == 1) computer.monotonic += Duration(far_ns(random));
    if (event == 2) (void)computer.clock.watch();
    const Stamp now = computer.clock.now();
    ASSERT_GE(now, before);
    if (event != 1) {
      ASSERT_EQ(now, expected) << "step " << i;
    }
    before = now;
  }
}

}  // namespace
}  // namespace madori
