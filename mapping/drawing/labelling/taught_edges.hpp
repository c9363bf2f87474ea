#pragma once

#include <vector>

#include "mapping/drawing/labelling/label_sheet.hpp"
#include "mapping/drawing/raster/detection_options.hpp"

namespace madori::mapping {

/// The probabilities after somebody has pointed at lines and said what they are: each touch speaks for the
/// edge that is nearest to it, and for all of the sheet the more the more alike they are in length, width,
/// grey, colour, fill and what they hang together with.
[[nodiscard]] std::vector<float> taught_edges(const LabelSheet& sheet, std::vector<float> probabilities,
                                              const std::vector<LineTouch>& touches);

}  // namespace madori::mapping
