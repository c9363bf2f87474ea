#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::mapping {

/// One straight face of a drawn wall, Map frame, metres (pixels while the site is unscaled).
struct Wall {
  int id = 0;
  Segment2<Map> segment;
  double probability = 1.0;  ///< that it is a wall: what the import says of a line that it took for one

  friend bool operator==(const Wall&, const Wall&) = default;
};
using Walls = std::vector<Wall>;

/// walls.csv: `id,x1,y1,x2,y2[,probability]`. Throws Error with file and line on anything but finite numbers.
[[nodiscard]] Walls load_walls(const std::filesystem::path& file);
/// The text of walls.csv; six digits after the point (micrometres), the probabilities where not all are
/// certain.
[[nodiscard]] std::string walls_csv(const Walls& walls);

}  // namespace madori::mapping
