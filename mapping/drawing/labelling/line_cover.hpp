#pragma once

#include <cstdint>
#include <vector>

#include "mapping/drawing/labelling/edge_sheet.hpp"
#include "mapping/drawing/labelling/feature_table.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

/// Which of a drawing's lines (pen strokes, sides of fills) an edge of its sheet belongs to, and back.
class LineCover {
 public:
  /// `lines` in pixels of a picture of which the sheet has u_scale x v_scale pixels for one.
  LineCover(const DrawnLines& lines, const EdgeSheet& sheet, double u_scale, double v_scale);

  /// The mean of `values` (one an edge) over the edges at a place of a line, `t` in 0..1 along it; less than
  /// 0 where no edge runs along it there.
  [[nodiscard]] double at(std::size_t line, double t, const std::vector<float>& values) const;
  /// How much of each edge lies on lines that `chosen` names, 0..1.
  [[nodiscard]] std::vector<float> covered(const std::vector<bool>& chosen) const;

 private:
  [[nodiscard]] PixelSegment on_sheet(const PixelSegment& s) const {
    return {s.u1 * u_scale_, s.v1 * v_scale_, s.u2 * u_scale_, s.v2 * v_scale_};
  }
  [[nodiscard]] double pixel_px() const;
  [[nodiscard]] double reach_px(const DrawnLine& line) const;

  const DrawnLines& lines_;
  const EdgeSheet& sheet_;
  double u_scale_, v_scale_;
};

}  // namespace madori::mapping
