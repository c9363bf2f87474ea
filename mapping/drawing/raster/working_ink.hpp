#pragma once

#include <optional>

#include "mapping/drawing/gray_image.hpp"
#include "mapping/drawing/raster/components.hpp"
#include "mapping/drawing/raster/detect_walls.hpp"

namespace madori::mapping {

/// The ink that the lines are looked for in.
struct WorkingInk {
  GrayImage ink;              ///< 255 = ink, 0 = paper
  Components marks;           ///< of that ink
  double pen_px = 1;          ///< the width of its thin pen
  double factor = 1;          ///< its pixels for one of the drawing
  double threshold = 0;       ///< on a paper of 255
  bool bright_lines = false;  ///< the drawing's lines are bright on a dark ground
};

/// Binarizes a drawing at a resolution at which a coarse pen neither multiplies the work nor changes what is
/// found. Bright lines on a dark ground (a CAD screen, a blueprint) are turned round first.
[[nodiscard]] WorkingInk working_ink(const GrayImage& drawing, std::optional<double> threshold);

/// The same options, their lengths in pixels of a picture resized by the factor.
[[nodiscard]] DetectionOptions resized(DetectionOptions options, double factor);

/// Turns segments in pixels of `ink` into pixels of the drawing that it was resized from.
void rescale(DetectedWalls& found, const GrayImage& ink, const GrayImage& drawing);

}  // namespace madori::mapping
