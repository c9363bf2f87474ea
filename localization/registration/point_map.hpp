#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// Points of the static map with a search tree, for the methods that match points to points.
class PointMap {
 public:
  explicit PointMap(std::vector<Point2<Map>> points);
  ~PointMap();
  PointMap(PointMap&&) noexcept;
  PointMap& operator=(PointMap&&) noexcept;

  struct Neighbour {
    std::size_t index = 0;
    double squared_distance_m2 = 0.0;
  };
  /// The point nearest to `p`. Precondition: the map is not empty.
  [[nodiscard]] Neighbour nearest(const Point2<Map>& p) const;
  [[nodiscard]] const std::vector<Point2<Map>>& points() const;
  [[nodiscard]] bool empty() const { return points().empty(); }

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Points along every wall, `spacing_m` apart at most, both ends among them.
[[nodiscard]] std::vector<Point2<Map>> sample_walls(const mapping::Walls& walls, double spacing_m);

}  // namespace madori::localization
