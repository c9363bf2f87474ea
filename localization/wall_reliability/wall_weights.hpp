#pragma once

#include <vector>

#include "localization/wall_reliability/wall_reliability.hpp"

namespace madori::localization {

/// The drawing as registration should take it after what driving has taught: walls that are not there left
/// out, displaced ones where they were seen, and how far each is to be believed. `walls[i]` has `weights[i]`,
/// 0..1, the form that SegmentGrid takes; ids are those of walls.csv, and may stand several times.
struct WallWeights {
  mapping::Walls walls;
  std::vector<double> weights;
};

/// Whether a piece is taken for gone: so many looks through it agree that wall_weights() leaves it out.
[[nodiscard]] bool is_surely_missing(const WallReliability& reliability, std::size_t cell);

/// Neighbouring pieces of a wall that are believed alike are put together again; walls of which nothing is
/// known come out as they went in, with weight 1.
[[nodiscard]] WallWeights wall_weights(const mapping::Walls& walls, const WallReliability& reliability);

}  // namespace madori::localization
