#pragma once

#include "mapping/drawing/labelling/edge_features.hpp"
#include "mapping/drawing/labelling/sheet_context.hpp"
#include "mapping/drawing/labelling/wall_model.hpp"

namespace madori::mapping {

/// A drawing as it is labelled: its edges, and all that is known of them.
struct LabelSheet {
  EdgeSheet edges;
  EdgeGroups groups;
  std::vector<double> width_px;  ///< of the stroke or body on an edge's dark side; 0 where there is none
  double pen_px = 1;
  FeatureTable features{0};
};

[[nodiscard]] LabelSheet label_sheet(EdgeSheet edges);

/// How probable it is that each edge of the sheet is a wall.
[[nodiscard]] std::vector<float> judge_edges(const LabelSheet& sheet, const WallModel& model);

}  // namespace madori::mapping
