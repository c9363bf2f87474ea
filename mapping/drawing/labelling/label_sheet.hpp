#pragma once

#include "mapping/drawing/labelling/edge_features.hpp"
#include "mapping/drawing/labelling/sheet_context.hpp"
#include "mapping/drawing/labelling/wall_model.hpp"

namespace madori::mapping {

/// A drawing as it is labelled: its edges, and all that is known of them.
struct LabelSheet {
  EdgeSheet edges;
  EdgeGroups groups;
  StrokeWidths strokes;
  FeatureTable features{0};
};

[[nodiscard]] LabelSheet label_sheet(EdgeSheet edges);

/// How probable it is that each edge of the sheet is a wall.
[[nodiscard]] std::vector<float> judge_edges(const LabelSheet& sheet, const WallModel& model);

}  // namespace madori::mapping
