#pragma once

#include <vector>

#include "mapping/drawing/raster/drawn_line.hpp"
#include "mapping/drawing/raster/text_marks.hpp"
#include "mapping/drawing/raster/wall_evidence.hpp"

namespace madori::mapping {

/// Rejects dimension lines, their ticks and extension lines: a thin single line along a number (or broken by
/// it), or one that carries slanted ticks at both ends (after D. Dori, "Dimensioning analysis", CACM 1992).
void reject_dimensions(DrawnLines& lines, const std::vector<TextGroup>& texts,
                       const std::vector<Evidence>& evidence, const WallStyle& style, double pen_px);

}  // namespace madori::mapping
