#pragma once

#include <ros/time.h>

#include <algorithm>
#include <cstdint>

namespace madori::sensors::rosbag_bridge {

inline constexpr std::int64_t kNanoseconds = 1'000'000'000;

inline std::int64_t to_ns(const ros::Time& time) {
  return static_cast<std::int64_t>(time.sec) * kNanoseconds + static_cast<std::int64_t>(time.nsec);
}
/// Bags know no time before 1970 and none of zero.
inline ros::Time to_time(std::int64_t stamp_ns) {
  const std::int64_t bounded = std::max<std::int64_t>(stamp_ns, 1);
  return ros::Time(static_cast<std::uint32_t>(bounded / kNanoseconds),
                   static_cast<std::uint32_t>(bounded % kNanoseconds));
}

}  // namespace madori::sensors::rosbag_bridge
