#pragma once

#include <cstdint>
#include <vector>

#include "core/stamp.hpp"

namespace madori::sensors {

/// A lidar's data packet as it came.
struct RawPacket {
  Stamp received{};
  std::vector<std::uint8_t> bytes;

  friend bool operator==(const RawPacket&, const RawPacket&) = default;
};

}  // namespace madori::sensors
