#pragma once

#include <vector>

#include "mapping/drawing/gray_image.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/strips.hpp"
#include "mapping/drawing/raster/wall_evidence.hpp"

namespace madori::mapping {

/// Which of the `asked` lines can only be seen from outside a closed building: on one side there is the paper
/// around the drawing, on the other a wall. All false where the outside reaches most places (a plan of
/// separate walls). `wall_px` is the largest thickness of a wall; openings up to it do not let the outside
/// in.
[[nodiscard]] std::vector<bool> faces_outside(const DrawnLines& lines, const std::vector<bool>& asked,
                                              const GrayImage& ink);

/// Faces that a wall can spare: those of solid fills, and the third line of a
/// wall that has two others.
[[nodiscard]] std::vector<bool> spare_faces(const DrawnLines& lines, const std::vector<Strip>& strips,
                                            const WallStyle& style);

/// The inner faces of cladding: a wall that has lost its other face to `outside` and has behind it, about as
/// long, the line that a vehicle inside sees instead; and pen lines that continue one of `outside`.
[[nodiscard]] std::vector<bool> cladding(const DrawnLines& lines, const std::vector<bool>& outside,
                                         const std::vector<Strip>& strips, const WallStyle& style);

}  // namespace madori::mapping
