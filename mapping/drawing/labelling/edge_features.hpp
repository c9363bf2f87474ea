#pragma once

#include "mapping/drawing/labelling/edge_network.hpp"
#include "mapping/drawing/labelling/edge_rays.hpp"
#include "mapping/drawing/labelling/edge_regions.hpp"
#include "mapping/drawing/labelling/edge_sheet.hpp"
#include "mapping/drawing/labelling/feature_table.hpp"

namespace madori::mapping {

/// What is measured of a sheet's edges, before it is made relative to the sheet.
struct EdgeMeasures {
  std::vector<EdgeViews> views;
  std::vector<EdgeLinks> links;
  std::vector<EdgeRegions> regions;
  std::vector<int> styles, looks;  ///< edges of a number look alike, closely or roughly
  std::vector<double> width_px;    ///< of the stroke or body on an edge's dark side; 0 where there is none
  double pen_px = 1;
};

[[nodiscard]] EdgeMeasures measure_edges(const EdgeSheet& sheet);

/// The features that the wall model knows, one row an edge.
[[nodiscard]] FeatureTable edge_features(const EdgeSheet& sheet, EdgeMeasures& measures);

}  // namespace madori::mapping
