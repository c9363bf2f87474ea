#include "localization/health/health.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "localization/health/reasons.hpp"

namespace madori::localization {
namespace {

std::string percent(double share) {
  return std::to_string(std::lround(100.0 * share)) + " %";
}

LocalizationHealth lost(const HealthEvidence& e, const HealthLimits& limits) {
  const auto because = [](std::string reason) {
    return LocalizationHealth{LocalizationState::Lost, std::move(reason)};
  };
  if (e.mirrored > limits.mirrored)
    return because(
        "the drawing seems to be mirrored: its mirror image fits what is seen better; import it the right "
        "way round");
  if (e.blind_scans >= limits.blind_scans && (e.blind_m > limits.blind_m || e.blind_s > limits.blind_s))
    return because(
        "the last " + std::to_string(e.blind_scans) +
        " scans agree neither with what was seen before nor with the wheels: moved by hand or covered?");
  if (!e.looked) return because(reason::kSearching.english);
  if (e.here >= limits.believed || e.around >= limits.localized) return {LocalizationState::Localized, ""};
  if (e.rival > limits.believed) return because(reason::kMovedByHand.english);
  if (e.rival > limits.rival) return {LocalizationState::Ambiguous, reason::kTwoAlike.english};
  return because(e.inliers < limits.explained ? reason::kNoPlace.english : reason::kNoneSure.english);
}

LocalizationHealth degraded(const HealthEvidence& e, const HealthLimits& limits) {
  const auto because = [](std::string reason) {
    return LocalizationHealth{LocalizationState::Degraded, std::move(reason)};
  };
  if (e.here < limits.believed) return because("the place is certain to a metre only: drive on slowly");
  if (e.here < limits.localized)
    return because(e.mirrored > 0.5 * (1.0 - e.here)
                       ? "the drawing may be mirrored: drive on slowly"
                       : "the place is certain to " + percent(e.here) + " only: drive on slowly");
  if (e.has_drawing && e.inliers < limits.explained)
    return because("the drawing explains only " + percent(e.inliers) + " of what is seen: drive on slowly");
  if (e.blind_scans > 1 && e.blind_s > 0.5 * limits.blind_s)
    return because("the last scans do not agree with what was seen before");
  if (e.off_walls)
    return because(
        "the last metres fit the drawing much less than usual: the drawing is poor here, or the pose is off");
  if (e.position_sigma_m > limits.degraded_sigma_m)
    return because("the position is uncertain by " + std::to_string(e.position_sigma_m).substr(0, 4) + " m");
  return {LocalizationState::Localized, ""};
}

}  // namespace

LocalizationHealth judge(const HealthEvidence& e, const HealthLimits& limits) {
  HealthEvidence evidence = e;
  if (!e.has_drawing) {  // mapping: nothing to compare with
    evidence.looked = true;
    evidence.here = 1.0;
  }
  LocalizationHealth health = lost(evidence, limits);
  if (health.state == LocalizationState::Localized) health = degraded(evidence, limits);
  health.place = std::max(evidence.here, evidence.around);
  return health;
}

}  // namespace madori::localization
