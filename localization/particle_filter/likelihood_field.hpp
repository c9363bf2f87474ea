#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapping/wall_map/grid_frame.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// What a return may come from (the beam mixture of Thrun, Burgard, Fox, Probabilistic Robotics, 6.3-6.4),
/// for a map that is a drawing: incomplete and in places wrong.
struct BeamModel {
  double hit_sigma_m = 0.10;   ///< of a return off its drawn wall: sensor noise and the drawing's own error
  double clutter = 0.3;        ///< share of the returns from things that are not drawn
  double short_decay_m = 3.0;  ///< undrawn things stand near: their density falls by e over this range
  double missing = 0.1;        ///< share of the drawn walls that are not there
  double range_max_m = 30.0;   ///< clutter that is not short lies anywhere up to here
  double effective_beams = 40.0;  ///< neighbouring beams err together: all together count as so many
};

/// Likelihood of a return at each place of the map, as one byte a cell: 0 = as likely as clutter, 255 = on a
/// wall. The outermost cells are 0, so that a look-up outside may be clamped to them.
class LikelihoodField {
 public:
  /// `reliability` is empty or one a wall, 0..1: how surely the wall is there (1 - missing where empty).
  LikelihoodField(const mapping::Walls& walls, const BeamModel& model, double cell_m = 0.05,
                  const std::vector<double>& reliability = {});

  [[nodiscard]] const BeamModel& model() const { return model_; }
  [[nodiscard]] const mapping::GridFrame& frame() const { return frame_; }
  /// Log-likelihood of one count over clutter, for a beam of weight one.
  [[nodiscard]] double nats_per_count() const { return nats_per_count_; }
  /// Row by row from the lowest.
  [[nodiscard]] std::span<const std::uint8_t> table() const { return table_; }
  /// Counts at `p`; 0 outside.
  [[nodiscard]] std::uint8_t counts(const Point2<Map>& p) const;
  /// How much a return at `range_m` tells, 0..1: near ones are the likelier clutter.
  [[nodiscard]] double information(double range_m) const;

 private:
  BeamModel model_;
  mapping::GridFrame frame_;
  double nats_per_count_ = 0.0;
  std::vector<std::uint8_t> table_;
};

}  // namespace madori::localization
