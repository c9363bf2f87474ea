#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapping/wall_map/grid_frame.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {

struct DistanceFieldOptions {
  double cell_m = 0.05;          ///< smaller is finer, and leaves the cache sooner: 100 m x 60 m is 2.4 MB
  double max_distance_m = 2.55;  ///< farther counts as this; one count of the table is a 255th of it
  double margin_m = 2.55;        ///< of cells around the outermost walls
};

/// How far each place is from the nearest drawn wall: one byte a cell, exact at the cell's centre up to half
/// a count. The table the particle filter and the scores read; small enough for the L2/L3 cache.
class DistanceField {
 public:
  explicit DistanceField(const Walls& walls, const DistanceFieldOptions& options = {});

  [[nodiscard]] const GridFrame& frame() const { return frame_; }
  [[nodiscard]] double max_distance_m() const { return max_distance_m_; }
  [[nodiscard]] double m_per_count() const { return max_distance_m_ / 255.0; }
  /// Row by row from the lowest, in counts.
  [[nodiscard]] std::span<const std::uint8_t> counts() const { return counts_; }
  /// Of the cell that holds `p`; max_distance_m() outside the grid.
  [[nodiscard]] double distance_m(const Point2<Map>& p) const {
    const std::int64_t cell = frame_.find(p);
    return cell < 0 ? max_distance_m_ : counts_[static_cast<std::size_t>(cell)] * m_per_count();
  }
  /// Free way from `from` along the unit vector (dx, dy) to the first wall, good to about a cell; `limit_m`
  /// when there is none before. Steps by the table's own distances.
  [[nodiscard]] double free_way_m(const Point2<Map>& from, double dx, double dy, double limit_m) const;

 private:
  GridFrame frame_;
  double max_distance_m_;
  std::vector<std::uint8_t> counts_;
};

}  // namespace madori::mapping
