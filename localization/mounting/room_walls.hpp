#pragma once

#include <optional>
#include <vector>

#include "core/lidar_model.hpp"
#include "localization/mounting/wall_pieces.hpp"

namespace madori::localization {

/// Where a drive took place: Base at its beginning, or the lidar of which alone is spoken.
struct Room {};

/// About a metre of wall that several sweeps saw: a line through `about`, moved along its normal by `offset`.
struct RoomWall {
  Point2<Room> about;
  double normal_rad = 0.0;  ///< direction of the normal, towards the lidar
  double offset_m = 0.0;
  int sightings = 0;           ///< sweeps that saw it: the lasers of one sweep are one look
  std::size_t last_sweep = 0;  ///< of these
};

/// Pieces farther off are of another wall.
struct WallGates {
  double beside_m;
  double turned_rad;
};

/// The walls of a room as one lidar sees them, put together piece by piece.
class RoomWalls {
 public:
  /// The nearest wall that the piece may lie on; nothing where there is none.
  [[nodiscard]] std::optional<std::size_t> find(const WallPiece& piece, const Transform2<Room, Lidar>& pose,
                                                const WallGates& gates) const;
  /// The same, counted as seen by the `sweep`; where there is none the piece begins one.
  std::size_t add(const WallPiece& piece, const Transform2<Room, Lidar>& pose, const WallGates& gates,
                  std::size_t sweep);
  [[nodiscard]] const std::vector<RoomWall>& walls() const { return walls_; }

 private:
  std::vector<RoomWall> walls_;
};

/// How much a piece's distance from its wall weighs, 1/m2: its returns scatter each by itself, and all of
/// them together by what beams and walls are uneven.
[[nodiscard]] double piece_weight(const WallPiece& piece, const LidarModel& lidar);

/// One lidar's motion by its own scans: its pose at each sweep, the first one at the origin. `turned_rad`:
/// how far it has turned since the first sweep by the wheels, good to some percent.
[[nodiscard]] std::vector<Transform2<Room, Lidar>> track_lidar(
    const std::vector<std::vector<WallPiece>>& sweeps, const std::vector<double>& turned_rad,
    const LidarModel& lidar);

}  // namespace madori::localization
