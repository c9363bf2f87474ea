#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/wall_map/grid_frame.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// A piece of a drawn wall, short enough to be right or wrong as one.
struct WallCell {
  std::size_t wall = 0;   ///< position in the walls given
  int wall_id = 0;        ///< `id` of walls.csv
  int piece = 0;          ///< counted from the wall's start
  Segment2<Map> segment;  ///< along the wall, in its direction
};

/// The drawn walls cut into equal pieces of about `length_m`; walls without length have none.
class WallCells {
 public:
  explicit WallCells(const mapping::Walls& walls, double length_m = 1.0);

  [[nodiscard]] const std::vector<WallCell>& all() const { return cells_; }
  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  /// The first piece of a wall; the pieces of wall i are first(i) up to first(i + 1).
  [[nodiscard]] std::size_t first(std::size_t wall) const { return first_[wall]; }
  /// The piece of a wall `along_m` from its start, clamped to its ends. Precondition: the wall has pieces.
  [[nodiscard]] std::size_t at(std::size_t wall, double along_m) const;
  /// All pieces within `radius_m` of a place, and some more; in their order.
  [[nodiscard]] std::vector<std::uint32_t> near(const Point2<Map>& place, double radius_m) const;

 private:
  std::vector<WallCell> cells_;
  std::vector<std::size_t> first_;
  std::vector<double> piece_length_m_;  ///< one a wall
  mapping::GridFrame frame_;            ///< of the buckets
  std::vector<std::vector<std::uint32_t>> buckets_;
};

}  // namespace madori::localization
