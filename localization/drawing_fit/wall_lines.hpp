#pragma once

#include "localization/drawing_fit/memory_cloud.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// What counts as a wall among remembered surfaces. Metres.
struct WallLineOptions {
  double least_length_m = 0.6;
  double largest_gap_m = 0.7;   ///< a longer gap ends a wall: a door
  double reach_m = 0.12;        ///< a surface this near to the line belongs to it
  int least_sightings = 2;      ///< keyframes that must have seen a surface; passers-by are seen once
  double least_standing = 0.5;  ///< of a surface: what was looked through more often than met is no wall
};

/// Straight walls in a memory, longest first: Hough transform over directed normals (the two faces of a thin
/// wall stay two), each line refined by total least squares and cut at its gaps. A wall's probability is the
/// mean `standing` of its surfaces. Deterministic.
[[nodiscard]] mapping::Walls wall_lines(const MemoryCloud& cloud, const WallLineOptions& options = {});

}  // namespace madori::localization
