#include "mapping/drawing/labelling/taught_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "mapping/drawing/labelling/log_odds.hpp"

namespace madori::mapping {
namespace {

constexpr double kTrust = 4;         // how far a touch moves the odds of its own edge, natural logarithm
constexpr double kAlike = 0.3;       // unlikeness at which it moves others by three fifths of that
constexpr double kUncertain = 1e-3;  // of every judgement, beside a touch

/// What edges are compared by, each 0..1 over the sheet.
constexpr std::array<const char*, 9> kCompared{"length_rank", "width_rank",     "contrast_rank",
                                               "dark_rank",   "dark_colour",    "cluster_size",
                                               "chain",       "dark_hit0_size", "dark_fill"};

std::vector<double> ranks(const FeatureTable& features, std::size_t column) {
  std::vector<std::size_t> order(features.rows());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return features.at(a, column) < features.at(b, column);
  });
  std::vector<double> rank(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool equal = k > 0 && features.at(order[k], column) == features.at(order[k - 1], column);
    rank[order[k]] = equal ? rank[order[k - 1]] : static_cast<double>(k) / static_cast<double>(order.size());
  }
  return rank;
}

double distance_px(const PixelSegment& s, double u, double v) {
  const double du = s.u2 - s.u1, dv = s.v2 - s.v1, square = std::max(1e-9, du * du + dv * dv);
  const double t = std::clamp(((u - s.u1) * du + (v - s.v1) * dv) / square, 0.0, 1.0);
  return std::hypot(u - s.u1 - t * du, v - s.v1 - t * dv);
}

std::size_t nearest(const EdgeSheet& sheet, const LineTouch& touch) {
  const double u = touch.u * sheet.factor, v = touch.v * sheet.factor;
  const auto at = std::min_element(sheet.edges.begin(), sheet.edges.end(), [&](const Edge& a, const Edge& b) {
    return distance_px(a.segment, u, v) < distance_px(b.segment, u, v);
  });
  return static_cast<std::size_t>(at - sheet.edges.begin());
}

}  // namespace

std::vector<float> taught_edges(const LabelSheet& sheet, std::vector<float> probabilities,
                                const std::vector<LineTouch>& touches) {
  if (touches.empty() || probabilities.empty()) return probabilities;
  std::vector<std::vector<double>> compared;
  const auto& names = sheet.features.names();
  for (const char* name : kCompared)
    compared.push_back(
        ranks(sheet.features,
              static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin())));
  std::vector<double> moved(probabilities.size());
  for (const LineTouch& touch : touches) {
    const std::size_t own = nearest(sheet.edges, touch);
    for (std::size_t i = 0; i < moved.size(); ++i) {
      double square = 0;
      for (const auto& rank : compared) square += (rank[i] - rank[own]) * (rank[i] - rank[own]);
      moved[i] += (touch.wall ? kTrust : -kTrust) * std::exp(-square / (2 * kAlike * kAlike));
    }
  }
  for (std::size_t i = 0; i < moved.size(); ++i)
    probabilities[i] = static_cast<float>(probability_of(log_odds(probabilities[i], kUncertain) + moved[i]));
  return probabilities;
}

}  // namespace madori::mapping
