#pragma once

#include "mapping/drawing/labelling/edge_features.hpp"
#include "mapping/drawing/labelling/wall_model.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

/// A drawing as it is labelled: its edges, and all that is known of them.
struct LabelSheet {
  EdgeSheet edges;
  FeatureTable features{0};
};

/// `drawn`: all lines of the drawing, those that some rule explains with the reason, in pixels of a picture
/// of which the drawing has u_scale x v_scale pixels for one.
[[nodiscard]] LabelSheet label_sheet(const GrayImage& drawing, const DrawnLines& drawn, double u_scale,
                                     double v_scale);

/// Gives every line the probability of its edges. A line that is wall in one part only is cut there; edges
/// that no line runs along (too pale for the ink) become lines of their own.
[[nodiscard]] DrawnLines label_lines(const LabelSheet& sheet, const std::vector<float>& probabilities,
                                     const DrawnLines& drawn, double u_scale, double v_scale);

}  // namespace madori::mapping
