#pragma once

#include "mapping/drawing/labelling/edge_network.hpp"
#include "mapping/drawing/labelling/edge_rays.hpp"
#include "mapping/drawing/labelling/edge_regions.hpp"
#include "mapping/drawing/labelling/edge_sheet.hpp"
#include "mapping/drawing/labelling/feature_table.hpp"

namespace madori::mapping {

/// Of the stroke or body on each edge's dark side, 0 where there is none; and of the pen that drew most.
struct StrokeWidths {
  std::vector<double> width_px;
  double pen_px = 1;
};

/// What is measured of a sheet's edges, before it is made relative to the sheet.
struct EdgeMeasures {
  std::vector<EdgeViews> views;
  std::vector<EdgeLinks> links;
  std::vector<EdgeRegions> regions;
  std::vector<int> styles, looks;  ///< edges of a number look alike, closely or roughly
  StrokeWidths strokes;
};

[[nodiscard]] EdgeMeasures measure_edges(const EdgeSheet& sheet);

/// The features that the wall model knows, one row an edge.
[[nodiscard]] FeatureTable edge_features(const EdgeSheet& sheet, EdgeMeasures& measures);

}  // namespace madori::mapping
