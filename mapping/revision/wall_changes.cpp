#include "mapping/revision/wall_changes.hpp"

#include <algorithm>
#include <cmath>

#include "core/segment_distance.hpp"

namespace madori::mapping {
namespace {

bool runs_along(const Segment2<Map>& wall, const std::vector<Segment2<Map>>& others, const Point2<Map>& at,
                const ChangeOptions& options) {
  const double length = wall.length_m();
  return std::ranges::any_of(others, [&](const Segment2<Map>& other) {
    const double other_length = other.length_m();
    if (!(other_length > 0.0) || distance_m(other, at) >= options.within) return false;
    const double cosine = ((wall.b.x_m - wall.a.x_m) * (other.b.x_m - other.a.x_m) +
                           (wall.b.y_m - wall.a.y_m) * (other.b.y_m - other.a.y_m)) /
                          (length * other_length);
    return std::abs(cosine) >= options.parallel_cosine;
  });
}

}  // namespace

std::vector<Segment2<Map>> pieces_without(const std::vector<Segment2<Map>>& walls,
                                          const std::vector<Segment2<Map>>& others,
                                          const ChangeOptions& options) {
  std::vector<Segment2<Map>> pieces;
  for (const auto& wall : walls) {
    const double length = wall.length_m();
    const auto steps = static_cast<std::size_t>(std::ceil(length / options.step));
    const auto place = [&](std::size_t i) {
      const double share = static_cast<double>(i) / static_cast<double>(steps);
      return Point2<Map>{wall.a.x_m + share * (wall.b.x_m - wall.a.x_m),
                         wall.a.y_m + share * (wall.b.y_m - wall.a.y_m)};
    };
    for (std::size_t i = 0; i < steps;) {
      std::size_t end = i;
      const auto middle = [&](std::size_t k) {
        const Point2<Map> a = place(k), b = place(k + 1);
        return Point2<Map>{(a.x_m + b.x_m) / 2.0, (a.y_m + b.y_m) / 2.0};
      };
      while (end < steps && !runs_along(wall, others, middle(end), options)) ++end;
      const Segment2<Map> piece{place(i), place(end)};
      if (end > i && piece.length_m() >= options.shortest) pieces.push_back(piece);
      i = std::max(end, i + 1);
    }
  }
  return pieces;
}

Walls walls_without(const Walls& walls, const std::vector<Segment2<Map>>& others,
                    const ChangeOptions& options) {
  Walls left;
  for (const Wall& wall : walls)
    for (const auto& piece : pieces_without({wall.segment}, others, options))
      left.push_back({static_cast<int>(left.size()) + 1, piece, wall.probability});
  return left;
}

}  // namespace madori::mapping
