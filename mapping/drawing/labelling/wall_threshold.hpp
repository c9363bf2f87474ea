#pragma once

#include <vector>

#include "mapping/drawing/labelling/edge_sheet.hpp"

namespace madori::mapping {

/// From which probability on an edge is taken for a wall on this sheet: where the expected F measure of the
/// walls taken, by length, is largest (Y. Nan et al., "Optimizing F-measure", ICML 2012), or beside it where
/// that costs hardly anything and fewer edges have such a probability: walls and other lines are two heaps,
/// and whatever the judges lean to, the threshold belongs between them. A sheet on which all is doubtful gets
/// a lower one than a clear sheet. `strictness` is what a wrong wall weighs against a missed one, 1 = alike.
[[nodiscard]] double wall_threshold(const std::vector<float>& probabilities, const std::vector<Edge>& edges,
                                    double strictness = 1);

}  // namespace madori::mapping
