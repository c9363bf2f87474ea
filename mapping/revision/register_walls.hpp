#pragma once

#include <optional>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "mapping/georeference/similarity_fit.hpp"

namespace madori::mapping {

/// How a new revision of a drawing lies on the old one.
struct WallRegistration {
  Similarity old_from_new;
  double covered = 0.0;  ///< share of the new walls' length that lies on old ones, 0..1
};

/// Lays the walls of a new drawing (in any unit, turned and moved) on the old ones. Every pair of long walls
/// says one similarity; the one under which most of the new length lies on old walls is refined by least
/// squares against the nearest walls (point to line). Walls that have changed take no part: they are far from
/// every old one. Nothing where less than `least_covered` of the new walls would lie on old ones. `within`:
/// how far a wall may be off to be the same, in the old walls' unit.
[[nodiscard]] std::optional<WallRegistration> register_walls(const std::vector<Segment2<Map>>& old_walls,
                                                             const std::vector<Segment2<Map>>& new_walls,
                                                             double within, double least_covered = 0.4);

/// The same from a place that is nearly right, say a person's: only the last step, to the walls that are
/// within four times `within`.
[[nodiscard]] WallRegistration settle_walls(const std::vector<Segment2<Map>>& old_walls,
                                            const std::vector<Segment2<Map>>& new_walls,
                                            const Similarity& from, double within);

/// A point by a similarity.
[[nodiscard]] Point2<Map> moved(const Similarity& by, const Point2<Map>& point);
[[nodiscard]] Segment2<Map> moved(const Similarity& by, const Segment2<Map>& segment);

}  // namespace madori::mapping
