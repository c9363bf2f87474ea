#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/lidar_model.hpp"
#include "core/point_cloud.hpp"
#include "localization/mounting/wall_pieces.hpp"
#include "localization/mounting/wheel_path.hpp"

namespace madori::localization {

/// What a short drive gave: sweeps and wheels on one clock. No drawing, and no place in it.
struct MountingDrive {
  std::vector<WheelReading> wheels;
  std::vector<PointCloud<Lidar>>
      sweeps;  ///< of all lidars, not deskewed; planar ones as points of their plane
};

/// How far a mounting was found.
enum class MountingKnown {
  Nothing,
  Yaw,  ///< where the lidar sits stays as it was given
  All,
};
/// What kept the rest from being found.
enum class MountingLack {
  Nothing,
  Sweeps,         ///< the lidar was hardly heard
  Walls,          ///< too few walls, or all in one direction
  Turn,           ///< the vehicle did not turn enough: x and y need that
  Straight,       ///< it did not drive enough straight on: everything needs that
  Contradiction,  ///< what was seen makes no room, or not with these wheels: a wheel on the other side or
                  ///< reversed, a lidar upside down
  Wheels,         ///< all was found, with wheels of quite another size than was given
};

struct FoundMounting {
  MountingKnown known = MountingKnown::Nothing;
  LidarMounting mounting{};                         ///< what was not found is as it was given
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  ///< of x, y (m), yaw (rad)
  MountingLack lack = MountingLack::Nothing;
  double residual_m = 0.0;         ///< RMS of pieces of wall off the walls that they are put together to
  int sweeps = 0;                  ///< that were used
  int walls = 0;                   ///< pieces of wall that several sweeps saw
  std::optional<FloorSeen> floor;  ///< of a spinning lidar that saw it: its height and how it leans
};

/// Two lidars that saw the same walls: how far the second one's lie beside the first one's.
struct LidarAgreement {
  std::size_t first = 0, second = 0;
  double apart_m = 0.0;  ///< RMS
  int walls = 0;
};

/// The wheels as they really are.
struct FoundWheels {
  WheelGeometry geometry;
  Eigen::Vector3d too_large = Eigen::Vector3d::Zero();  ///< left, right, distance: share of what was believed
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();      ///< of these
};

struct MountingCalibration {
  std::vector<FoundMounting> lidars;
  std::optional<FoundWheels> wheels;  ///< where some mounting was found
  double turned_rad = 0.0;            ///< all directions added up
  double driven_m = 0.0;
  std::vector<LidarAgreement> agreements;
};

/// Hand-eye calibration of several lidars against the wheels, from one short drive between walls: rotating
/// tells where a lidar sits about the middle of the axle, driving straight on which way it looks. Unknowns
/// are the mountings, the two wheels' radii and their distance (no wheel is as large as everybody believes),
/// the vehicle's poses, and the lines of the walls; least squares over wheels and pieces of wall (Ceres,
/// Cauchy loss). The start comes from each lidar's own motion by its scans and the closed form of Censi et
/// al., "Simultaneous calibration of odometry and sensor parameters for mobile robots" (2013), with the
/// rotation of the scans; the mountings of `lidars` need not be near. Wheels do not slide sideways, the
/// lidar's metre is the truth, and the vehicle stands at the first sweeps. Nothing is found where the answer
/// contradicts what went into it: less than half of the pieces lie on walls that several sweeps saw, the way
/// by the wheels lies three sigmas beside the poses, or a wheel would have to turn the other way round.
[[nodiscard]] MountingCalibration calibrate_mounting(const MountingDrive& drive,
                                                     const std::vector<LidarModel>& lidars,
                                                     const WheelGeometry& believed);

}  // namespace madori::localization
