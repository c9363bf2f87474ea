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

  friend bool operator==(const Wall&, const Wall&) = default;
};
using Walls = std::vector<Wall>;

/// walls.csv: `id,x1,y1,x2,y2`. Throws Error with file and line on anything that is not five finite numbers.
[[nodiscard]] Walls load_walls(const std::filesystem::path& file);
/// The text of walls.csv; six digits after the point (micrometres).
[[nodiscard]] std::string walls_csv(const Walls& walls);

}  // namespace madori::mapping
