#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/frames.hpp"
#include "core/stamp.hpp"
#include "core/transform2.hpp"

namespace madori::app {

/// A mounting as it was typed, against what is measured.
struct MountingDoubt {
  enum class Of { Height, Tilt, Yaw };
  Of of = Of::Height;
  std::size_t lidar = 0;
  double found = 0.0;  ///< metres above the floor; degrees
  double typed = 0.0;
};

/// Compares the typed mountings with what the lidars see: height and tilt with the floor while the vehicle
/// stands, the yaw with where the vehicle gets to while it drives straight on. Plain values: recordings keep
/// it as it is.
struct MountingWatch {
  static constexpr std::size_t kLooks = 7, kLidars = 4, kLegs = 7;

  /// A lidar above the floor, the newest looks of a standing vehicle.
  struct Floor {
    std::array<double, kLooks> height_m{};
    std::array<double, kLooks> tilt_rad{};
    std::size_t count = 0;
    Stamp looked{};
  };
  std::array<Floor, kLidars> floors{};
  /// A straight leg, and how far beside the heading the vehicle got in each of the last ones.
  std::optional<Transform2<Odom, Base>> odom_begun;
  Transform2<Map, Base> map_begun;
  std::array<double, kLegs> beside_rad{};
  std::size_t legs = 0;

  std::optional<MountingDoubt> height;  ///< or tilt
  std::optional<MountingDoubt> yaw;

  [[nodiscard]] std::optional<MountingDoubt> doubt() const { return height ? height : yaw; }
};

}  // namespace madori::app
