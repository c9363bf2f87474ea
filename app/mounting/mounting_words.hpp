#pragma once

#include "app/cycle/notice.hpp"
#include "localization/mounting/mounting_calibration.hpp"

/// What is said while the mountings are measured, and of what came of it.
namespace madori::app {

inline constexpr CatalogueEntry kMountingDriveSilent{
    "drive-silent", "the drive does not answer: check its power and its cable"};
inline constexpr CatalogueEntry kMountingDriveStopped{
    "drive-stopped",
    "emergency stop, bumper or a fault of the drive stopped it: release it, then measure again"};
inline constexpr CatalogueEntry kMountingLidarSilent{"lidar-silent",
                                                     "lidar {name} is silent: check its power and its cable"};
inline constexpr CatalogueEntry kMountingField{
    "field", "something stands in the safety scanner's protective field: clear it"};
inline constexpr CatalogueEntry kMountingBlocked{
    "blocked", "something stands in the way: clear a metre before the vehicle and the space to turn around"};
inline constexpr CatalogueEntry kMountingStopped{"stopped", "stopped by a person: measure again"};
inline constexpr CatalogueEntry kMountingMoved{
    "no-way", "the vehicle was told to drive and did not: free its wheels, then measure again"};

inline constexpr CatalogueEntry kLackSweeps{"lack-sweeps",
                                            "hardly any sweep came: check the lidar and its cable"};
inline constexpr CatalogueEntry kLackWalls{
    "lack-walls", "too few walls are in sight: measure where walls are seen in two directions"};
inline constexpr CatalogueEntry kLackTurn{
    "lack-turn", "x and y stay as typed: the vehicle must turn by at least 120 degrees"};
inline constexpr CatalogueEntry kLackStraight{
    "lack-straight", "nothing can be told: the vehicle must drive a metre straight on"};
inline constexpr CatalogueEntry kLackContradiction{
    "lack-contradiction",
    "what the lidar saw and what the wheels turned do not fit together: check each wheel's size, side and "
    "direction, and that the lidar hangs upright"};
inline constexpr CatalogueEntry kLackWheels{"lack-wheels",
                                            "the wheels are not as typed: left {left} %, right {right} %, "
                                            "distance {distance} %; correct wheel_radius_m "
                                            "and half_wheel_separation_m"};

/// What kept the rest of a mounting from being found; empty where nothing did.
[[nodiscard]] inline Notice lack_words(localization::MountingLack lack) {
  using localization::MountingLack;
  switch (lack) {
    case MountingLack::Sweeps:
      return notice(kLackSweeps);
    case MountingLack::Walls:
      return notice(kLackWalls);
    case MountingLack::Turn:
      return notice(kLackTurn);
    case MountingLack::Straight:
      return notice(kLackStraight);
    case MountingLack::Contradiction:
      return notice(kLackContradiction);
    case MountingLack::Wheels:
      return notice(kLackWheels);
    case MountingLack::Nothing:
      break;
  }
  return {};
}

}  // namespace madori::app
