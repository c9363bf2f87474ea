#include "sensors/device_clock.hpp"

#include <gtest/gtest.h>

#include <random>

namespace madori::sensors {
namespace {

/// A device that sends every 10 ms; its packets come up to 8 ms late, and its clock began 5,000 s after ours.
class DeviceClockTest : public testing::Test {
 protected:
  /// One more packet, `late_s` later than usual. How far off its stamp is.
  double packet(double late_s = 0.0) {
    device_us_ += 10'000;
    const Stamp true_stamp = stamp_from_seconds(5'000.0 + ours_s_ + 1e-6 * static_cast<double>(device_us_));
    clock_.observe(device_us_, true_stamp + duration_from_seconds(late_s + jitter_(random_)));
    return to_seconds(clock_.stamp_of(device_us_) - true_stamp);
  }
  double packets(double seconds) {
    double off_s = 0.0;
    for (int i = 0; i < static_cast<int>(100.0 * seconds); ++i) off_s = packet();
    return off_s;
  }

  DeviceClock clock_;
  std::mt19937 random_{3};
  std::uniform_real_distribution<double> jitter_{0.0, 0.008};
  std::int64_t device_us_ = 0;
  double ours_s_ = 0.0;  ///< what was added to our clock
};

TEST_F(DeviceClockTest, AClockThatWasSetIsFollowed) {
  for (const double step_s : {3600.0, 0.2, -0.2, 7.0, -3600.0}) {
    EXPECT_LT(packets(10.0), 0.002);
    ours_s_ += step_s;
    EXPECT_NEAR(packets(6.1), 0.0, 0.002) << step_s;
  }
}

TEST_F(DeviceClockTest, ABacklogIsNotTakenForASetClock) {
  EXPECT_LT(packets(10.0), 0.002);
  for (const double kept_s : {2.4, 4.0, 15.0}) {  // by sockets and ports while the computer stood still
    for (int i = 0; i < static_cast<int>(100.0 * kept_s); ++i)
      EXPECT_NEAR(packet(20.0 - 0.01 * i), 0.0, 0.002) << kept_s << " s: " << i;
    EXPECT_NEAR(packets(10.0), 0.0, 0.002);
  }
}

TEST_F(DeviceClockTest, ABusyComputerWhosePacketsOftenComeLateKeepsTheBest) {
  EXPECT_LT(packets(10.0), 0.002);
  for (int i = 0; i < 3000; ++i) EXPECT_NEAR(packet(i % 50 == 0 ? 0.0 : 0.3), 0.0, 0.006) << i;
}

}  // namespace
}  // namespace madori::sensors
