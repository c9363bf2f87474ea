#pragma once

#include <vector>

#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/strips.hpp"

namespace madori::mapping {

/// What the walls of this drawing look like, measured on its strips.
struct WallStyle {
  double thickness_px = 0;  ///< commonest distance of two wall faces
  double narrowest_px = 0;
  double widest_empty_px = 0;   ///< two lines with nothing between are no wall beyond this distance
  double widest_filled_px = 0;  ///< the same with hatching or a solid fill between
  double bold_px = 0;           ///< a pen stroke at least this thick is a wall in itself
  double wall_pen_px = 0;       ///< stroke that the faces of its walls are drawn with
  bool pens_differ = false;     ///< much is drawn with a clearly finer pen than the walls
  double finer_than_px = 0;     ///< a stroke up to this width is drawn with another, finer pen than the walls
  double filled_share = 0;      ///< of the length of all wall-like strips: how much is filled or bold
};

/// The peaks of the strip widths weighted by length. With no strips, 4 pens.
[[nodiscard]] WallStyle measure_style(const DrawnLines& lines, const std::vector<Strip>& strips,
                                      double pen_px);

/// How much speaks for each line being the face of a wall.
struct Evidence {
  double paired_px = 0;  ///< length with another face at wall thickness beside it
  double filled_px = 0;  ///< of that, with hatching or a solid fill between, or drawn with a bold pen
  double width_px = 0;   ///< of the walls that it is a face of
};
[[nodiscard]] std::vector<Evidence> weigh_lines(const DrawnLines& lines, const std::vector<Strip>& strips,
                                                const WallStyle& style);

}  // namespace madori::mapping
