#include "mapping/drawing/labelling/wall_threshold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace madori::mapping {
namespace {

constexpr double kAsGood = 0.99;  // of the largest expected F measure: nobody can tell these thresholds apart
constexpr double kCertain = 1e-3;  // no judgement is more certain than that
constexpr double kBlur = 0.3;      // of a probability, natural logarithm of its odds
constexpr std::size_t kPlaces = 60;

double odds(double p) {
  p = std::clamp(p, kCertain, 1 - kCertain);
  return std::log(p / (1 - p));
}

/// Where between two probabilities the sheet has the least length of edges.
double emptiest(double low, double high, const std::vector<float>& probabilities,
                const std::vector<Edge>& edges) {
  const double from = odds(low), step = (odds(high) - from) / (kPlaces - 1);
  if (step <= 0) return high;
  std::array<double, kPlaces> crowd{};
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t k = 0; k < kPlaces; ++k) {
      const double off = (from + static_cast<double>(k) * step - odds(probabilities[i])) / kBlur;
      crowd[k] += edges[i].length_px * std::exp(-0.5 * off * off);
    }
  const auto least = std::min_element(crowd.begin(), crowd.end()) - crowd.begin();
  return std::clamp(1 / (1 + std::exp(-(from + static_cast<double>(least) * step))), low, high);
}

/// The threshold of the largest score, and those that nobody can tell from it.
struct Range {
  double best = 0.5, loosest = 0.5, strictest = 0.5;
};

Range best_range(const std::vector<float>& probabilities, const std::vector<Edge>& edges, double strictness) {
  std::vector<std::size_t> order(edges.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probabilities[a] > probabilities[b]; });
  double expected = 0;  // length of walls on the sheet
  for (std::size_t i = 0; i < edges.size(); ++i) expected += probabilities[i] * edges[i].length_px;
  double right = 0, taken = 0, best = -1;
  Range range;
  std::vector<double> scores;
  for (const std::size_t i : order) {
    right += probabilities[i] * edges[i].length_px;
    taken += edges[i].length_px;
    scores.push_back(right / (strictness * taken + expected));  // grows with the F measure
    if (scores.back() > best) best = scores.back(), range.best = probabilities[i];
  }
  range.strictest = 0;
  for (std::size_t k = 0; k < order.size(); ++k)
    if (scores[k] >= kAsGood * best) {
      range.loosest = probabilities[order[k]];
      range.strictest = std::max(range.strictest, range.loosest);
    }
  return range;
}

}  // namespace

double wall_threshold(const std::vector<float>& probabilities, const std::vector<Edge>& edges,
                      double strictness) {
  const Range even = best_range(probabilities, edges, 1);
  const double between =
      edges.empty() ? even.best : emptiest(even.loosest, even.strictest, probabilities, edges);
  if (strictness == 1) return between;
  // a person's strictness moves the threshold by as much as it moves the best one
  const double shift = odds(best_range(probabilities, edges, strictness).best) - odds(even.best);
  return 1 / (1 + std::exp(-(odds(between) + shift)));
}

}  // namespace madori::mapping
