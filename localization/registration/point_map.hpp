#pragma once

#include <memory>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// What surface the points around one of them make: a line through their mean, however thick noise made it.
struct PointSurface {
  double x_m = 0.0;
  double y_m = 0.0;
  double normal_x = 0.0;
  double normal_y = 0.0;
  double flatness = 0.0;  ///< 0 a blot or a lone point, 1 a line
  double worth = 1.0;     ///< less where the points are known to make no line
};

/// The points of a map with noise, and how they were seen.
struct NoisyPoints {
  std::vector<Point2<Map>> points;
  std::vector<double> weights;  ///< one a point: how often it was seen
  double noise_m = 0.0;         ///< sigma of what was seen
};

/// Points of a map with a search tree, for the methods that match points to points. What the points were made
/// of does not matter: sampled walls of a drawing, a map that grows scan by scan, the surfaces of keyframes.
class PointMap {
 public:
  /// `surface_radius_m`: the points this near to one make its surface; 0: no surfaces are made.
  explicit PointMap(std::vector<Point2<Map>> points, double surface_radius_m = 0.2);
  /// Surfaces are the ridges of the cloud: what is seen most, however thick noise makes it. Where the points
  /// spread wider about their line than noise alone spreads them (corners, two surfaces) they make none.
  PointMap(NoisyPoints cloud, double surface_radius_m);
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
  /// What the points around point `i` make, worked out when it is asked for first: not for several threads. A
  /// blot at the point itself where no surfaces are made.
  [[nodiscard]] const PointSurface& surface(std::size_t i) const;
  [[nodiscard]] bool empty() const { return points().empty(); }

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// Points along every wall, `spacing_m` apart at most, both ends among them.
[[nodiscard]] std::vector<Point2<Map>> sample_walls(const mapping::Walls& walls, double spacing_m);

}  // namespace madori::localization
