#pragma once

#include "mapping/drawing/gray_image.hpp"

namespace madori::mapping {

/// Fills the pores of dense hatching: enclosed spots of paper no larger than a few pen widths across. A
/// densely hatched wall becomes a solid one; the wide spaces between sparse hatch lines stay. Returns how
/// many.
std::size_t fill_pores(GrayImage& ink, double pen_px);

}  // namespace madori::mapping
