#include "localization/global/global_answer.hpp"

#include <algorithm>
#include <cmath>

#include "localization/health/reasons.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

constexpr double kCertain = 0.9999;       ///< probability from which on the best is an answer
constexpr double kWellExplained = 0.6;    ///< a best that puts less of the scan on walls must also ...
constexpr double kClearNats = 25.0;       ///< ... lead by this log-likelihood: chance fits lead by up to 20
constexpr double kLeastExplained = 0.35;  ///< share of the scan's weight that an answer puts on walls
/// Share of beams through drawn walls, above which a best must both explain well and lead clearly.
constexpr double kDoubtfulThrough = 0.12;
constexpr double kMostThrough = 0.25;  ///< share of the beams that an answer may lead through drawn walls

void sort_by_likelihood(std::vector<Hypothesis>& all) {
  std::sort(all.begin(), all.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_likelihood > b.log_likelihood; });
}

/// Relative to the first, which is the likeliest: the exponentials cannot overflow.
void fill_in_probabilities(std::vector<Hypothesis>& all) {
  double sum = 0.0;
  for (const Hypothesis& h : all) sum += std::exp(h.log_likelihood - all.front().log_likelihood);
  for (Hypothesis& h : all) h.probability = std::exp(h.log_likelihood - all.front().log_likelihood) / sum;
}

/// State and reason, from hypotheses by falling likelihood; at least one.
void believe_or_doubt(GlobalAnswer& answer) {
  const auto& all = answer.hypotheses;
  const Hypothesis& best = all.front();
  const double lead = all.size() > 1 ? best.log_likelihood - all[1].log_likelihood : kClearNats;
  const bool is_clear = best.fit.inlier_fraction >= kWellExplained && lead >= kClearNats;
  if (best.fit.inlier_fraction < kLeastExplained) {
    answer.reason = reason::kNoPlace.english;
  } else if (best.through_walls > kMostThrough) {
    answer.reason = reason::kThroughWalls.english;
  } else if (best.probability < kCertain) {
    answer.state = GlobalState::Ambiguous;
    answer.reason = reason::kTwoAlike.english;
  } else if (best.fit.inlier_fraction < kWellExplained && lead < kClearNats) {
    answer.state = GlobalState::Ambiguous;
    answer.reason = reason::kMuchUndrawn.english;
  } else if (best.through_walls > kDoubtfulThrough && !is_clear) {
    answer.state = GlobalState::Ambiguous;
    answer.reason = reason::kThroughSomeWalls.english;
  } else {
    answer.state = GlobalState::Found;
  }
}

}  // namespace

const char* to_string(GlobalState state) {
  switch (state) {
    case GlobalState::Found:
      return "FOUND";
    case GlobalState::Ambiguous:
      return "AMBIGUOUS";
    case GlobalState::Nowhere:
      return "NOWHERE";
  }
  return "NOWHERE";
}

GlobalAnswer decide(std::vector<Hypothesis> hypotheses) {
  GlobalAnswer answer;
  answer.hypotheses = std::move(hypotheses);
  if (answer.hypotheses.empty()) {
    answer.reason = reason::kNothingToSearch.english;
    return answer;
  }
  sort_by_likelihood(answer.hypotheses);
  fill_in_probabilities(answer.hypotheses);
  believe_or_doubt(answer);
  return answer;
}

std::vector<Hypothesis> distinct(std::vector<Hypothesis> all, double same_m, double same_rad) {
  sort_by_likelihood(all);
  std::vector<Hypothesis> kept;
  for (const Hypothesis& h : all)
    if (std::none_of(kept.begin(), kept.end(), [&](const Hypothesis& k) {
          return same_place(k.fit.map_from_base, h.fit.map_from_base, same_m, same_rad);
        }))
      kept.push_back(h);
  return kept;
}

}  // namespace madori::localization
