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

struct WallWeightOptions {
  double sure_looks = 5.0;    ///< before a wall is left out or moved
  double sure_share = 0.7;    ///< of the looks that must agree
  double sure_sigma_m = 0.1;  ///< a place beside that is less certain is not used
  double unsure = 0.3;        ///< weight of a piece that is neither sure nor confirmed
};

/// Whether a piece is taken for gone: so many looks through it agree that wall_weights() leaves it out.
[[nodiscard]] bool is_surely_missing(const WallReliability& reliability, std::size_t cell,
                                     const WallWeightOptions& options = {});

/// Neighbouring pieces of a wall that are believed alike are put together again; walls of which nothing is
/// known come out as they went in, with weight 1.
[[nodiscard]] WallWeights wall_weights(const mapping::Walls& walls, const WallReliability& reliability,
                                       const WallWeightOptions& options = {});

}  // namespace madori::localization
