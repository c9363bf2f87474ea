#pragma once

#include "mapping/drawing/raster/clean_marks.hpp"
#include "mapping/drawing/raster/components.hpp"
#include "mapping/drawing/raster/detection_options.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/wall_evidence.hpp"

namespace madori::mapping {

/// Gives every line that is no wall the reason why; what has none is a wall. Returns what the walls look
/// like. `ink` is the cleaned drawing, `marks` its components.
WallStyle choose_walls(DrawnLines& drawn, const GrayImage& ink, const Components& marks,
                       const CleanedMarks& cleaned, const DetectionOptions& options);

/// The faces of the pillars among the columns: between one and a half and three and a half wall thicknesses.
[[nodiscard]] std::vector<PixelSegment> column_faces(const CleanedMarks& cleaned, const WallStyle& style);

}  // namespace madori::mapping
