#include "mapping/drawing/labelling/label_sheet.hpp"

#include <utility>

namespace madori::mapping {

LabelSheet label_sheet(EdgeSheet edges) {
  LabelSheet sheet;
  EdgeMeasures measures = measure_edges(edges);
  sheet.features = edge_features(edges, measures);
  sheet.strokes = std::move(measures.strokes);
  auto& [styles, looks, chains, clusters] = sheet.groups.together;
  styles = std::move(measures.styles);
  looks = std::move(measures.looks);
  for (std::size_t i = 0; i < edges.edges.size(); ++i) {
    chains.push_back(static_cast<int>(measures.links[i].chain.number));
    clusters.push_back(static_cast<int>(measures.links[i].cluster.number));
    sheet.groups.partner[0].push_back(measures.views[i].dark.hits[0].edge);
    sheet.groups.partner[1].push_back(measures.views[i].bright.hits[0].edge);
  }
  sheet.edges = std::move(edges);
  return sheet;
}

std::vector<float> judge_edges(const LabelSheet& sheet, const WallModel& model) {
  std::vector<PixelSegment> segments;
  for (const Edge& edge : sheet.edges.edges) segments.push_back(edge.segment);
  FeatureTable context = sheet_context(segments, sheet.groups, model.first(sheet.features));
  context.add(sheet.features);
  return model.second(context);
}

}  // namespace madori::mapping
