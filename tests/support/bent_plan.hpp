#pragma once

#include <random>
#include <utility>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::test {

enum class BuildingKind { Office, Hall, Corridors };

/// What stands or falls together in a plan: the outline of a piece of wall, a rack, a pillar, a recess.
struct PlanPart {
  std::vector<Segment2<Map>> lines;  ///< free floor to the right of a -> b
  int room = -1;                     ///< parts of one room shift together; -1 does not shift
};

/// A straight plan, metres, from (0, 0) to (width, height), and a way through it.
struct Plan {
  double width_m = 0.0;
  double height_m = 0.0;
  int rooms = 0;
  std::vector<PlanPart> parts;
  std::vector<Point2<Map>> nodes;
  std::vector<std::pair<std::size_t, std::size_t>> legs;
  std::vector<std::size_t> lap;
};

/// A random plan: an office with rooms around a ring of corridors and a core, a hall with racks, columns and
/// machines, or corridors around solid blocks.
[[nodiscard]] Plan random_plan(BuildingKind kind, bool symmetric, std::mt19937& engine);

}  // namespace madori::test
