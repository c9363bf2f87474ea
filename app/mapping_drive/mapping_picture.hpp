#pragma once

#include <cstddef>
#include <vector>

#include "localization/memory/memory.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {

/// What was seen so far, Map frame (the first pose is its origin).
struct MappingPicture {
  std::size_t revision = 0;
  std::vector<Point2<Map>> points;
  mapping::Walls walls;
};

/// The points of all keyframes, at most one a cell, and the straight walls among them.
[[nodiscard]] MappingPicture picture_of(const localization::Memory& memory);

}  // namespace madori::app
