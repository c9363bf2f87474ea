#include "core/stamp.hpp"

#include <gtest/gtest.h>

namespace madori {
namespace {

TEST(Stamp, KeepsMicrosecondsOfUnixTimes) {
  EXPECT_EQ(stamp_from_seconds(976052857.337277).time_since_epoch() / std::chrono::microseconds(1),
            976052857337277);
}

TEST(Stamp, RoundsNegativeSeconds) {
  EXPECT_EQ(duration_from_seconds(-0.25), std::chrono::milliseconds(-250));
}

}  // namespace
}  // namespace madori
