#include "mapping/drawing/labelling/wall_threshold.hpp"

#include <algorithm>
#include <numeric>

namespace madori::mapping {

double wall_threshold(const std::vector<float>& probabilities, const std::vector<Edge>& edges,
                      double strictness) {
  std::vector<std::size_t> order(edges.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probabilities[a] > probabilities[b]; });
  double expected = 0;  // length of walls on the sheet
  for (const std::size_t i : order) expected += probabilities[i] * edges[i].length_px;
  double right = 0, taken = 0, best = -1, threshold = 0.5;
  for (const std::size_t i : order) {
    right += probabilities[i] * edges[i].length_px;
    taken += edges[i].length_px;
    const double score = right / (strictness * taken + expected);  // grows with the F measure
    if (score > best) best = score, threshold = probabilities[i];
  }
  return threshold;
}

}  // namespace madori::mapping
