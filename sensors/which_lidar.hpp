#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori::sensors {

/// A lidar of the vehicle, as a log may tell of it.
struct MountedLidar {
  std::string name;
  std::string frame;      ///< in which our own recordings tell what it sees
  std::size_t place = 0;  ///< among the vehicle's
  bool planar = false;
  Transform2<Base, Lidar> base_from_lidar;
  double height_m = 0.0;  ///< above the floor
};

/// Of which lidar a topic's messages are: of the one whose frame they name; of the planar one that /scan or
/// /scan/N counts to by its place; of the only one of the kind, or the only one at all. Null where that does
/// not tell.
[[nodiscard]] const MountedLidar* which_lidar(const std::vector<MountedLidar>& lidars, bool planar,
                                              const std::string& topic, std::string frame);

/// "a, b", for messages.
[[nodiscard]] std::string names_of(const std::vector<MountedLidar>& lidars);

}  // namespace madori::sensors
