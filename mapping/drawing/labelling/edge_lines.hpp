#pragma once

#include "mapping/drawing/labelling/label_sheet.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

/// How the edges of a sheet are drawn: with a pen, or as the faces of a body.
class EdgeStrokes {
 public:
  explicit EdgeStrokes(const LabelSheet& sheet);

  /// The two edges of a pen stroke are one line and have one probability.
  [[nodiscard]] std::vector<float> together(const std::vector<float>& probabilities) const;

  /// The lines of the drawing, in pixels of the sheet: the two edges of a pen stroke are one line in its
  /// middle, the edges of anything thicker are faces. Each has the probability of its edges; pieces of one
  /// straight line are one line where both are walls (at least `wall_from` probable) or both are none, and no
  /// more than `gap_px` apart (by default as far as a crossing stroke interrupts them).
  [[nodiscard]] DrawnLines lines(const std::vector<float>& probabilities, double wall_from,
                                 std::optional<double> gap_px) const;

 private:
  [[nodiscard]] bool is_stroke(std::size_t edge) const {
    return sheet_.strokes.width_px[edge] > 0 && sheet_.strokes.width_px[edge] <= widest_px_;
  }

  const LabelSheet& sheet_;
  double widest_px_;
};

}  // namespace madori::mapping
