#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/transform2.hpp"
#include "localization/drawing_fit/wall_index.hpp"
#include "localization/memory/surface_scan.hpp"
#include "localization/wall_reliability/wall_cells.hpp"

namespace madori::localization {

/// What one scan says of one piece of a drawn wall.
struct WallLook {
  std::uint32_t cell = 0;
  int ended = 0;   ///< beams that ended on a surface that runs as the wall does, in its place or beside it
  int passed = 0;  ///< beams that went through where it is drawn, wherever its ends and the pose are, and on
  double offset_m = 0.0;  ///< median of the ended ones: how far beside, positive to the left of a -> b
  double sigma_m = 0.0;   ///< of the offset: by the beams and by the pose
};

struct LookOptions {
  double reach_m = 20.0;          ///< farther pieces are met by too few beams
  double beside_m = 1.1;          ///< a surface farther beside than this is another thing
  double through_m = 0.3;         ///< a beam counts as gone through when it ends so far behind
  double parallel_cosine = 0.94;  ///< between the normals of surface and wall
  double flattest_sine = 0.17;    ///< of the angle between beam and wall, below which nothing is told
  double range_sigma_m = 0.02;
  double ends_m = 0.15;  ///< a wall in place may end so much earlier than it is drawn
};

/// Sorts the beams of a scan at a pose, whose covariance is of (x, y, yaw) in the Map frame, onto the pieces
/// of wall around: which beams met each, went through, or were stopped before (these say nothing). A surface
/// belongs to the nearest drawn wall of its direction, so that the far face of a wall is not taken for the
/// near one misdrawn. Pieces of which nothing was learned are left out.
[[nodiscard]] std::vector<WallLook> wall_looks(const WallCells& cells, const WallIndex& index,
                                               const SurfaceScan& scan,
                                               const Transform2<Map, Base>& map_from_base,
                                               const Eigen::Matrix3d& covariance,
                                               const LookOptions& options = {});

}  // namespace madori::localization
