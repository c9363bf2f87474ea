#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "simulation/world/mesh.hpp"

namespace madori::simulation {

/// A convex floor outline that a vehicle can run into; two corners make a thin wall.
struct Obstacle {
  std::string name;
  std::vector<Point2<Building>> outline;
  HeightRange z;
};

/// Whether two convex outlines (one, two or more corners, any order of turning) share a point: separating
/// axes over the edges' normals of both.
[[nodiscard]] bool overlap(const std::vector<Point2<Building>>& a, const std::vector<Point2<Building>>& b);

/// Everything that never moves, found by place (2 m grid).
class ObstacleIndex {
 public:
  void add(Obstacle obstacle);
  /// The first obstacle (in order of addition) that meets the outline between those heights; null when free.
  [[nodiscard]] const Obstacle* find(const std::vector<Point2<Building>>& outline,
                                     const HeightRange& z) const;
  [[nodiscard]] const std::vector<Obstacle>& all() const { return obstacles_; }

 private:
  std::vector<Obstacle> obstacles_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace madori::simulation
