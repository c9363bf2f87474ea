#include "localization/registration/point_map.hpp"

#include <cmath>
#include <cstdint>
#include <nanoflann.hpp>
#include <optional>
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
  std::vector<double> weights;  ///< empty: all one
  double noise_m = 0.0;
  std::vector<std::optional<PointSurface>> surfaces;
  double surface_radius_m = 0.0;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Tree>, Tree, 2> index;
};

namespace {

/// The points near a place.
using Near = std::vector<std::pair<std::uint32_t, double>>;
template <class Tree>
void find_near(const Tree& tree, double x_m, double y_m, double radius_m, Near& near) {
  const double query[2] = {x_m, y_m};
  near.clear();
  tree.index.radiusSearch(query, radius_m * radius_m, near, nanoflann::SearchParams(0, 0.0F, false));
}

/// Which way points with these second moments run, and how flat they lie.
void take_line(PointSurface& surface, double xx, double xy, double yy) {
  const double spread = std::hypot(0.5 * (xx - yy), xy);
  const double large = 0.5 * (xx + yy) + spread;
  const double direction = 0.5 * std::atan2(2.0 * xy, xx - yy);
  surface.normal_x = -std::sin(direction);
  surface.normal_y = std::cos(direction);
  surface.flatness = large > 0.0 ? 2.0 * spread / large : 0.0;
}

/// Total least squares over the points at `near`.
PointSurface surface_of(const std::vector<Point2<Map>>& points, const Near& near) {
  PointSurface surface;
  const auto n = static_cast<double>(near.size());
  for (const auto& [i, squared] : near) {
    surface.x_m += points[i].x_m / n;
    surface.y_m += points[i].y_m / n;
  }
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const auto& [i, squared] : near) {
    const double dx = points[i].x_m - surface.x_m;
    const double dy = points[i].y_m - surface.y_m;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  take_line(surface, xx, xy, yy);
  if (near.size() <= 2) surface.flatness = 0.0;
  return surface;
}

/// One step to the ridge: weighted total least squares in a round window, moved across the line alone.
template <class Tree>
void step_to_ridge(const Tree& tree, const Near& near, double window_m, PointSurface& surface) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (const auto& [i, unused] : near) {
    const double dx = tree.points[i].x_m - surface.x_m, dy = tree.points[i].y_m - surface.y_m;
    const double w = tree.weights[i] * std::exp(-0.5 * (dx * dx + dy * dy) / (window_m * window_m));
    n += w, x += w * dx, y += w * dy, xx += w * dx * dx, xy += w * dx * dy, yy += w * dy * dy;
  }
  if (n <= 0.0) return;
  x /= n, y /= n;
  xx = xx / n - x * x, xy = xy / n - x * y, yy = yy / n - y * y;
  take_line(surface, xx, xy, yy);
  const double off = x * surface.normal_x + y * surface.normal_y;
  surface.x_m += off * surface.normal_x;
  surface.y_m += off * surface.normal_y;
}

/// Whether points are spread about the line as noise alone spreads them.
template <class Tree>
bool is_line(const Tree& tree, const Near& near, double window_m, const PointSurface& surface) {
  constexpr double kMostSpread = 1.2;
  constexpr double kReach = 3.0;
  double n = 0.0, squares_m2 = 0.0;
  for (const auto& [i, unused] : near) {
    const double dx = tree.points[i].x_m - surface.x_m, dy = tree.points[i].y_m - surface.y_m;
    const double across = dx * surface.normal_x + dy * surface.normal_y;
    const double along = dy * surface.normal_x - dx * surface.normal_y;
    if (std::abs(along) > window_m || std::abs(across) > kReach * window_m) continue;
    n += tree.weights[i];
    squares_m2 += tree.weights[i] * across * across;
  }
  return squares_m2 < n * kMostSpread * kMostSpread * tree.noise_m * tree.noise_m;
}

template <class Tree>
PointSurface ridge_at(const Tree& tree, const Point2<Map>& p) {
  constexpr int kSteps = 4;
  constexpr double kCorner = 0.1;  // what a piece that is no line is worth beside one that is
  const double window_m = 0.5 * tree.surface_radius_m;
  PointSurface surface{p.x_m, p.y_m, 1.0, 0.0, 0.0};
  Near near;
  for (int k = 0; k < kSteps; ++k) {
    find_near(tree, surface.x_m, surface.y_m, 2.5 * window_m, near);
    step_to_ridge(tree, near, window_m, surface);
  }
  find_near(tree, surface.x_m, surface.y_m, 3.2 * window_m, near);
  if (is_line(tree, near, window_m, surface)) {
    surface.flatness = 1.0;
  } else {
    surface.worth = kCorner;
  }
  return surface;
}

}  // namespace

PointMap::PointMap(NoisyPoints cloud, double surface_radius_m)
    : PointMap(std::move(cloud.points), surface_radius_m) {
  tree_->weights = std::move(cloud.weights);
  tree_->noise_m = cloud.noise_m;
}

PointMap::PointMap(std::vector<Point2<Map>> points, double surface_radius_m)
    : tree_(std::make_unique<Tree>(std::move(points))) {
  tree_->surface_radius_m = surface_radius_m;
  tree_->surfaces.resize(tree_->points.size());
}

const PointSurface& PointMap::surface(std::size_t i) const {
  std::optional<PointSurface>& surface = tree_->surfaces[i];
  if (surface) return *surface;
  const Point2<Map>& p = tree_->points[i];
  const double radius = tree_->surface_radius_m;
  surface = PointSurface{p.x_m, p.y_m, 1.0, 0.0, 0.0};
  if (tree_->noise_m > 0.0) {
    surface = ridge_at(*tree_, p);
  } else if (radius > 0.0) {
    Near near;
    find_near(*tree_, p.x_m, p.y_m, radius, near);
    surface = surface_of(tree_->points, near);
  }
  return *surface;
}
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
