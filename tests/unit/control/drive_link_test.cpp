#include "control/drive_link/drive_link.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "control/drive_link/controller.hpp"
#include "core/clock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/pseudo_terminal.hpp"

namespace madori::control {
namespace {

using test::eventually;

/// A controller on the other end of the cable; every step is 10 ms of its own time.
class Device {
 public:
  void step() {
    for (const std::uint8_t byte : cable.read()) controller.receive(byte, now_us_);
    controller.tick({.battery_mv = 24'000}, now_us_ += 10'000);
    std::uint8_t frame[wire::kMaxFrame];
    const std::size_t size = controller.status_frame(frame);
    cable.write({frame, size});
  }

  test::PseudoTerminal cable;
  wire::Controller controller;

 private:
  std::uint32_t now_us_ = 0;
};

/// What the link's thread tells.
struct Told {
  void operator()(const wire::Status& status, Duration drive_behind) {
    const std::scoped_lock lock(mutex);
    newest = status;
    behind = drive_behind;
  }
  [[nodiscard]] wire::DriveState state() {
    const std::scoped_lock lock(mutex);
    return newest ? newest->state : wire::DriveState::Fault;
  }

  std::mutex mutex;
  std::optional<wire::Status> newest;
  Duration behind{};
};

/// Whether the controller answers that it is healthy, once it has taken commands.
bool answers(Device& device, DriveLink& link, Told& told) {
  return eventually([&] {
    link.send({}, false);
    device.step();
    return told.state() == wire::DriveState::Idle;
  });
}

TEST(DriveLink, DrivesAControllerOverASerialLine) {
  Device device;
  Told told;
  DriveLink link({.device = device.cable.name()}, std::ref(told));
  ASSERT_TRUE(eventually([&] { return link.is_open(); }));
  ASSERT_TRUE(answers(device, link, told));
  ASSERT_TRUE(eventually([&] {
    device.step();
    link.send({}, false);  // again: on a busy computer the device has gone silent meanwhile
    link.send({1.5, -0.25}, true);
    return told.state() == wire::DriveState::Running && device.controller.left_uradps() == 1'500'000;
  }));
  EXPECT_EQ(device.controller.right_uradps(), -250'000);
  ASSERT_TRUE(eventually([&] {  // the control loop hangs: nobody sends
    device.step();
    return told.state() == wire::DriveState::WatchdogStop;
  }));
  EXPECT_EQ(told.newest->battery_mv, 24'000);
  EXPECT_EQ(told.behind, Duration{});  // it has taken all that was sent
  EXPECT_EQ(link.counters().damaged, 0U);
}

TEST(DriveLink, TellsHowFarTheDriveIsBehind) {
  Device device;
  Told told;
  DriveLink link({.device = device.cable.name()}, std::ref(told));
  ASSERT_TRUE(eventually([&] { return link.is_open(); }));
  const Stamp before = clock_now();  // what answers() sent last may be on the way, too
  ASSERT_TRUE(answers(device, link, told));
  link.send({}, false);  // stays on the way: the device does not read
  const auto taken = device.controller.next_status();
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  std::array<std::uint8_t, wire::kMaxFrame> frame{};
  device.cable.write({frame.data(), wire::encode(taken, frame.data())});
  ASSERT_TRUE(eventually([&] {
    const std::scoped_lock lock(told.mutex);
    return told.behind >= std::chrono::milliseconds(30);
  }));
  EXPECT_LE(told.behind, clock_now() - before);
}

/// Beside a list of all that was told.
RC_GTEST_PROP(CommandLag, IsTheAgeOfTheOldestCommandThatWasNotTaken, ()) {
  CommandLag lag;
  auto sequence = *rc::gen::arbitrary<std::uint16_t>();  // it wraps
  const auto taken = static_cast<std::uint16_t>(sequence + *rc::gen::inRange(-3, 300));
  std::vector<std::pair<std::uint16_t, Stamp>> all;
  Stamp now{};
  for (const int gap_ms : *rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 100))) {
    now += std::chrono::milliseconds(gap_ms);
    all.emplace_back(++sequence, now);
    lag.told(sequence, now);
  }
  const auto next =
      std::ranges::find(all, static_cast<std::uint16_t>(taken + 1U), &std::pair<std::uint16_t, Stamp>::first);
  const bool known = next != all.end() && all.end() - next <= 256;
  RC_ASSERT(lag.behind(taken, now) == (known ? now - next->second : Duration{}));
}

TEST(DriveLink, ASecondProgramIsKeptOutAndComesInOnceTheFirstHasEnded) {
  const Device device;
  auto first = std::make_unique<DriveLink>(DriveLinkOptions{.device = device.cable.name()});
  ASSERT_TRUE(eventually([&] { return first->is_open(); }));
  const DriveLink second({.device = device.cable.name()});
  EXPECT_TRUE(eventually([&] { return second.problem().find("another program") != std::string::npos; }))
      << second.problem();
  EXPECT_FALSE(second.is_open());
  first.reset();
  EXPECT_TRUE(eventually([&] { return second.is_open(); }));
}

TEST(DriveLink, WhatCameBeforeThePortWasOpenedIsNotTaken) {
  Device device;
  const int kept_open = ::open(device.cable.name().c_str(), O_RDWR | O_NOCTTY);  // else nothing is buffered
  ASSERT_GE(kept_open, 0);
  constexpr int kBefore = 20;
  for (int i = 0; i < kBefore; ++i) device.step();
  ASSERT_TRUE(eventually([&] {
    int waiting = 0;
    return ::ioctl(kept_open, FIONREAD, &waiting) == 0 && waiting > 0;
  }));
  std::atomic<int> first = -1;
  DriveLink link({.device = device.cable.name()}, [&](const wire::Status& status, Duration /*behind*/) {
    int none = -1;
    first.compare_exchange_strong(none, status.sequence);
  });
  ASSERT_TRUE(eventually([&] { return link.is_open(); }));
  ASSERT_TRUE(eventually([&] {
    device.step();
    return first >= 0;
  }));
  EXPECT_GE(first, kBefore);
  ::close(kept_open);
}

TEST(DriveLink, SendsNothingThatIsNoNumber) {
  Device device;
  DriveLink link({.device = device.cable.name()});
  ASSERT_TRUE(eventually([&] { return link.is_open(); }));
  EXPECT_FALSE(link.send({std::nan(""), 0.0}, true));
  EXPECT_FALSE(link.send({0.0, 101.0}, true));
  EXPECT_EQ(link.counters().refused_commands, 2U);
  EXPECT_EQ(link.counters().commands, 0U);
}

TEST(DriveLink, OpensAgainWhenTheCableComesBack) {
  DriveLink missing({.device = "/dev/no-such-drive"});
  EXPECT_TRUE(eventually([&] { return missing.problem().find("/dev/no-such-drive: No such file") == 0; }));
  EXPECT_FALSE(missing.send({}, false));

  const std::string name = [] {
    test::PseudoTerminal probe;
    return probe.name();
  }();
  DriveLink link({.device = name});  // nothing is there yet
  EXPECT_TRUE(eventually([&] { return !link.problem().empty(); }));
  Device device;
  if (device.cable.name() != name) GTEST_SKIP() << "the system gave another pseudo-terminal";
  EXPECT_TRUE(eventually([&] {
    device.step();
    return link.counters().status_frames > 0;
  }));
}

}  // namespace
}  // namespace madori::control
