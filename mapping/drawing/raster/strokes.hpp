#pragma once

#include <vector>

#include "mapping/drawing/gray_image.hpp"
#include "mapping/drawing/raster/components.hpp"

namespace madori::mapping {

/// How often ink runs of each length occur, across (all) and down (a sample, scaled up): element i counts
/// length i. A straight stroke shows with its thickness, once for every pixel of its length.
using RunLengths = std::vector<double>;
[[nodiscard]] RunLengths run_lengths(const GrayImage& ink, const Components& marks);

/// The width of the thin pen, pixels: the finest run length that stands out among the common ones.
[[nodiscard]] double pen_width_px(const RunLengths& runs);

/// The thickness from which a stroke counts as solid: the emptiest place of the run lengths between the pen
/// and four pens, so that no kind of wall in this drawing lies astride of it.
[[nodiscard]] double solid_from_px(const RunLengths& runs, double pen_px);

/// Ink split by thickness: walls drawn as solid fills, and lines drawn with a pen.
struct Strokes {
  GrayImage solid;  ///< 255 where the ink is at least `solid_from_px` thick
  GrayImage thin;   ///< 255 on the rest of the ink
  double solid_from_px = 0;
};

/// An opening of the ink by a disc (a box, then diamonds), grown back a little further within the ink.
[[nodiscard]] Strokes split_strokes(const GrayImage& ink, double solid_from_px);

}  // namespace madori::mapping
