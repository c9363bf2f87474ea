#pragma once

#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {

struct ChangeOptions {
  double within = 0.15;   ///< a wall nearer than this to one of its direction is the same wall
  double shortest = 0.5;  ///< shorter pieces are how two drawings end a wall, no change
  double step = 0.05;     ///< along a wall
  double parallel_cosine = 0.9;
};

/// The pieces of `walls` along which no wall of `others` runs.
[[nodiscard]] std::vector<Segment2<Map>> pieces_without(const std::vector<Segment2<Map>>& walls,
                                                        const std::vector<Segment2<Map>>& others,
                                                        const ChangeOptions& options = {});
/// The same of walls: each piece is as probable as the wall that it is of. Numbered from 1.
[[nodiscard]] Walls walls_without(const Walls& walls, const std::vector<Segment2<Map>>& others,
                                  const ChangeOptions& options = {});

}  // namespace madori::mapping
