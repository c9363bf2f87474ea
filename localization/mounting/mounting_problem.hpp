#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/lidar_model.hpp"
#include "localization/mounting/room_walls.hpp"
#include "localization/mounting/wheel_path.hpp"

namespace madori::localization {

/// A sweep that is used: what it saw of walls, when, and where the vehicle was at its end.
struct CalibrationSweep {
  std::size_t lidar = 0;
  Stamp end{};
  std::vector<WallPiece> pieces;
  std::array<double, 3> room_from_base{};  ///< x, y (m), yaw (rad, not wrapped)
};

/// All unknowns of the calibration but the walls.
struct CalibrationState {
  std::vector<CalibrationSweep> sweeps;                ///< in the order of time
  std::vector<std::array<double, 3>> base_from_lidar;  ///< x, y, yaw of each lidar
  std::array<double, 3> wheels{};  ///< left and right radius and the distance between, share too large
};

/// What is known of the answer.
struct CalibrationQuality {
  bool good = false;
  std::vector<Eigen::Matrix3d> covariance;  ///< of each mounting
  Eigen::Vector3d wheel_sigma{0, 0, 0};     ///< of the state's `wheels`
  double way_off = 0.0;            ///< RMS of the way that these wheels tell beside the poses, sigmas
  double sizes_off = 0.0;          ///< RMS of the wheels' sizes beside what was believed, sigmas
  std::vector<double> on_walls;    ///< share of each lidar's pieces on walls that several sweeps saw
  std::vector<double> residual_m;  ///< of each lidar's pieces off their walls, a robust RMS
  std::vector<std::vector<RoomWall>> walls;  ///< as each lidar saw them, in the room
};

/// Least squares over everything (Ceres): wheels between successive sweeps, pieces of wall on lines, weak
/// priors that keep `believed` what nothing tells. Improves `state`, with walls put together anew before.
CalibrationQuality solve_mounting(CalibrationState& state, const WheelPath& path,
                                  const std::vector<LidarModel>& believed, const WallGates& gates);

}  // namespace madori::localization
