#pragma once

#include "mapping/drawing/raster/components.hpp"
#include "mapping/drawing/raster/detection_options.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/stage_clock.hpp"

namespace madori::mapping {

/// All lines of the cleaned ink, whatever they mean: strokes split by thickness, thinned or outlined, Hough
/// seeds followed and fitted, the rest traced, collinear pieces merged, their strokes measured. `marks` are
/// those of `ink`.
[[nodiscard]] DrawnLines extract_lines(const GrayImage& ink, const Components& marks, double pen_px,
                                       const DetectionOptions& options, StageClock& clock);

}  // namespace madori::mapping
