#include "localization/registration/point_map.hpp"

#include <cmath>
#include <nanoflann.hpp>
#include <utility>

namespace madori::localization {

struct PointMap::Tree {
  explicit Tree(std::vector<Point2<Map>> p) : points(std::move(p)), index(2, *this, {10}) {}

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t dimension) const {
    return dimension == 0 ? points[i].x_m : points[i].y_m;
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*unused*/) const {
    return false;
  }

  std::vector<Point2<Map>> points;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree>, Tree, 2> index;
};

PointMap::PointMap(std::vector<Point2<Map>> points) : tree_(std::make_unique<Tree>(std::move(points))) {}
PointMap::~PointMap() = default;
PointMap::PointMap(PointMap&&) noexcept = default;
PointMap& PointMap::operator=(PointMap&&) noexcept = default;

PointMap::Neighbour PointMap::nearest(const Point2<Map>& p) const {
  const double query[2] = {p.x_m, p.y_m};
  std::size_t index = 0;
  double squared = 0.0;
  nanoflann::KNNResultSet<double> result(1);
  result.init(&index, &squared);
  tree_->index.findNeighbors(result, query, nanoflann::SearchParams());
  return {index, squared};
}

const std::vector<Point2<Map>>& PointMap::points() const {
  return tree_->points;
}

std::vector<Point2<Map>> sample_walls(const mapping::Walls& walls, double spacing_m) {
  std::vector<Point2<Map>> points;
  for (const mapping::Wall& wall : walls) {
    const auto& [a, b] = wall.segment;
    const int pieces = std::max(1, static_cast<int>(std::ceil(wall.segment.length_m() / spacing_m)));
    for (int i = 0; i <= pieces; ++i) {
      const double t = static_cast<double>(i) / pieces;
      points.push_back({a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)});
    }
  }
  return points;
}

}  // namespace madori::localization
