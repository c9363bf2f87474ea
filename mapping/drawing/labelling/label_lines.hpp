#pragma once

#include "mapping/drawing/labelling/edge_features.hpp"
#include "mapping/drawing/labelling/sheet_context.hpp"
#include "mapping/drawing/labelling/wall_model.hpp"
#include "mapping/drawing/raster/drawn_line.hpp"

namespace madori::mapping {

/// A drawing as it is labelled: its edges, and all that is known of them.
struct LabelSheet {
  EdgeSheet edges;
  EdgeGroups groups;
  FeatureTable features{0};
};

[[nodiscard]] LabelSheet label_sheet(const GrayImage& drawing);

/// How probable it is that each edge of the sheet is a wall.
[[nodiscard]] std::vector<float> judge_edges(const LabelSheet& sheet, const WallModel& model);

/// Gives every line of `drawn` the probability of its edges; they are in pixels of a picture of which the
/// drawing has u_scale x v_scale pixels for one. A line that is wall in one part only
/// (at least `wall_from` probable) is cut there; edges
/// that no line runs along (too pale for the ink) become lines of their own.
[[nodiscard]] DrawnLines label_lines(const LabelSheet& sheet, const std::vector<float>& probabilities,
                                     const DrawnLines& drawn, double u_scale, double v_scale,
                                     double wall_from);

}  // namespace madori::mapping
