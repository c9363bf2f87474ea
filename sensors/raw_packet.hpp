#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/stamp.hpp"

namespace madori::sensors {

/// A lidar's data packet as it came.
struct RawPacket {
  Stamp received{};
  std::vector<std::uint8_t> bytes;
  std::size_t lidar = 0;  ///< whose: its place among the vehicle's

  friend bool operator==(const RawPacket&, const RawPacket&) = default;
};

}  // namespace madori::sensors
