#include "localization/wall_tracker/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "localization/health/reasons.hpp"
#include "localization/wall_tracker/same_place.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// Starts for registration within two sigma of a given pose: half a metre and ten degrees apart, so that each
/// pose between them is drawn to the same walls.
std::vector<Pose> around(const Pose& given, const PoseSigma& sigma) {
  constexpr double kStepM = 0.5;
  constexpr double kStepRad = 0.17;
  constexpr double kMost = 6.0;
  const double reach_m = std::min(2.0 * sigma.position_m, kMost * kStepM);
  const double reach_rad = std::min(2.0 * sigma.yaw_rad, kPi);
  const int n = static_cast<int>(std::ceil(reach_m / kStepM));
  const int turns = static_cast<int>(std::ceil(reach_rad / kStepRad));
  std::vector<Pose> starts;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -turns; k <= turns; ++k)
        if (i * i + j * j <= n * n)
          starts.emplace_back(given.x_m() + i * reach_m / n, given.y_m() + j * reach_m / n,
                              given.yaw_rad() + k * reach_rad / turns);
  return starts;
}

LocalizationHealth unfound(GlobalState state, std::string reason) {
  return {state == GlobalState::Ambiguous ? LocalizationState::Ambiguous : LocalizationState::Lost,
          std::move(reason)};
}

}  // namespace

void PlaceSearch::restart(std::optional<GlobalAnswer> known) {
  answer_ = std::move(known);
  agreeing_ = 0;
  given_.reset();
}

Sighting PlaceSearch::observe(const ScanPoints& points, const Transform2<Base, Base>& moved,
                              const Pose& given, const GlobalLocalizer& global) {
  if (given_) return check(points, given, global);
  GlobalAnswer answer = answer_ ? global.locate(points, *answer_, moved) : global.locate(points);
  const bool found = answer.state == GlobalState::Found;
  const bool agrees = found && answer_ && answer_->state == GlobalState::Found &&
                      is_same_place(answer.hypotheses.front().fit.map_from_base,
                                    answer_->hypotheses.front().fit.map_from_base * moved);
  agreeing_ = found ? (agrees ? agreeing_ + 1 : 1) : 0;
  answer_ = std::move(answer);
  if (agreeing_ >= sightings_to_start_) return {answer_->hypotheses.front().fit, {}};
  return {std::nullopt, unfound(answer_->state, found ? reason::kOnceMore.english : answer_->reason)};
}

/// Is the vehicle within two sigma of the given pose?
Sighting PlaceSearch::check(const ScanPoints& points, const Pose& given, const GlobalLocalizer& global) {
  answer_ = global.judge(points, around(given, *given_));
  given_.reset();
  if (answer_->state == GlobalState::Found) return {answer_->hypotheses.front().fit, {}};
  return {std::nullopt, unfound(answer_->state, reason::kGivenRefuted.english + answer_->reason)};
}

std::vector<PoseHypothesis> PlaceSearch::hypotheses(const Transform2<Base, Base>& moved) const {
  constexpr std::size_t kMost = 10;
  constexpr double kLeastProbability = 1e-3;
  std::vector<PoseHypothesis> list;
  if (!answer_) return list;
  for (const auto& h : answer_->hypotheses)
    if (list.size() < kMost && h.probability >= kLeastProbability)
      list.push_back({h.fit.map_from_base * moved, h.probability, h.fit.inlier_fraction});
  return list;
}

}  // namespace madori::localization
