#pragma once

#include <array>
#include <vector>

#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// A stretch of a drawn line, metres from its start.
struct SeenStretch {
  double from_m = 0.0;
  double to_m = 0.0;
};

/// The stretches of a line that can be seen from the left of a -> b ([0]) and from the right ([1]).
using VisibleFace = std::array<std::vector<SeenStretch>, 2>;

/// From which sides each line can be seen: not through the other face of its wall, a line that is more likely
/// drawn for a wall than not, runs likewise and lies at most a wall's thickness away. Between two such lines
/// nothing is known of the faces, and both sides count as seen.
[[nodiscard]] std::vector<VisibleFace> visible_faces(const mapping::Walls& walls);

}  // namespace madori::localization
