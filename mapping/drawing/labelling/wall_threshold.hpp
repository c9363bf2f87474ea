#pragma once

#include <vector>

#include "mapping/drawing/labelling/edge_sheet.hpp"

namespace madori::mapping {

/// A wrong wall weighs this much against a missed one: whoever localizes by walls takes a wrong one for
/// doubtful by its probability, one that is missing is missing for good.
inline constexpr double kStrictness = 0.8;

/// From which probability on an edge is taken for a wall on this sheet: where the expected F measure of the
/// walls taken, by length, is largest (Y. Nan et al., "Optimizing F-measure", ICML 2012). A sheet on which
/// all is doubtful gets a lower one than a clear sheet.
[[nodiscard]] double wall_threshold(const std::vector<float>& probabilities, const std::vector<Edge>& edges,
                                    double strictness = kStrictness);

}  // namespace madori::mapping
