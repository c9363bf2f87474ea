#pragma once

#include "core/frames.hpp"
#include "core/stamp.hpp"
#include "core/transform2.hpp"

namespace madori {

/// Where dead reckoning says the vehicle is. Only differences of two readings mean anything.
struct OdometryReading {
  Stamp stamp{};
  Transform2<Odom, Base> odom_from_base;
};

}  // namespace madori
