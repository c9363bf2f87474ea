#pragma once

#include <vector>

#include "mapping/drawing/raster/columns.hpp"
#include "mapping/drawing/raster/detection_options.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/text_marks.hpp"

namespace madori::mapping {

/// What was recognised by its marks alone and taken out of the ink.
struct CleanedMarks {
  double pen_px = 1;
  std::vector<TextGroup> texts;
  DrawnLines dashes;  ///< axes of the dashes, `chain` numbers the dashed line
  std::vector<Column> columns;
  std::vector<RejectedSegment> rejected;
};

/// Erases text, dashed lines and dirt from the ink and fills the pores of dense hatching. `marks` are those
/// of the ink as it comes, `pen_px` the width of its thin pen.
[[nodiscard]] CleanedMarks clean_marks(GrayImage& ink, const Components& marks, double pen_px,
                                       const DetectionOptions& options);

}  // namespace madori::mapping
