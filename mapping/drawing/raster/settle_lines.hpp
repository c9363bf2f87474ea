#pragma once

#include <opencv2/core/types.hpp>

#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// What the lines are settled on.
struct GreyDrawing {
  const GrayImage& image;     ///< as it was drawn
  cv::Point2d scale{1, 1};    ///< its pixels for one pixel of the lines
  bool bright_lines = false;  ///< on a dark ground
};

/// Moves each line that is not rejected to where the grey levels of the drawing have it, to a fraction of a
/// pixel: the face of a fill to where the grey passes half way from ink to paper, a stroke to the middle
/// between its two edges. Binary pixels cannot tell this: an outline of pixels lies half a pixel inside the
/// ink, and the middle of a stroke of even width lies half a pixel to one side. Lines move by at most 1.5
/// pixels and keep their length; those with too few clear edges (crossings, hatching along them) stay.
void settle_lines(DrawnLines& lines, const GreyDrawing& drawing);

}  // namespace madori::mapping
