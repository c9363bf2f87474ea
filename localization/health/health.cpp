#include "localization/health/health.hpp"

#include <cmath>
#include <string>

namespace madori::localization {
namespace {

std::string percent(double share) {
  return std::to_string(std::lround(100.0 * share)) + " %";
}

constexpr double kOnlyPlaceNats = -15.0;  // any other place this far behind

/// All places were looked at, and none comes near: a bad fit is a poor drawing then, not a wrong place.
bool is_the_only_place(const HealthEvidence& e) {
  return e.elsewhere_nats > HealthEvidence::kNotLooked && e.elsewhere_nats < kOnlyPlaceNats &&
         e.mirrored_nats < kOnlyPlaceNats;
}

LocalizationHealth lost(const HealthEvidence& e, const HealthLimits& limits) {
  if (e.searching) {
    return {LocalizationState::Lost, "looking for the place on the drawing: drive on slowly by hand"};
  }
  if (e.mirrored_nats > limits.mirrored_nats) {
    return {
        LocalizationState::Lost,
        "the drawing seems to be mirrored: its mirror image fits what is seen better; import it the right "
        "way round"};
  }
  if (e.blind_scans >= limits.blind_scans && (e.blind_m > limits.blind_m || e.blind_s > limits.blind_s)) {
    return {
        LocalizationState::Lost,
        "the last " + std::to_string(e.blind_scans) +
            " scans agree neither with what was seen before nor with the wheels: moved by hand or covered?"};
  }
  if (e.elsewhere_nats > limits.contradicted_nats) {
    return {LocalizationState::Lost, "another place on the drawing fits clearly better: wrong start pose?"};
  }
  if (e.walls_seen > limits.enough_walls && e.fit_nats < limits.lost_nats_a_wall * e.walls_seen &&
      !is_the_only_place(e)) {
    return {LocalizationState::Lost, "what is seen does not fit the drawing here (" + percent(e.inliers) +
                                         " explained): wrong start pose, wrong or mirrored drawing"};
  }
  return {LocalizationState::Localized, ""};
}

LocalizationHealth degraded(const HealthEvidence& e, const HealthLimits& limits) {
  const auto because = [](std::string reason) {
    return LocalizationHealth{LocalizationState::Degraded, std::move(reason)};
  };
  if (e.fit_nats < (e.verified ? limits.doubted_nats : limits.verified_nats)) {
    return because("too little of the drawing seen yet to be sure of the start pose: drive on slowly");
  }
  if (e.fit_nats < limits.good_nats_a_wall * e.walls_seen || e.inliers < limits.good_inliers) {
    return because("only " + percent(e.inliers) + " of what is seen is on the drawing");
  }
  if (e.blind_scans > 1 && e.blind_s > 0.5 * limits.blind_s) {
    return because("the last scans do not agree with what was seen before");
  }
  if (e.off_walls) {
    return because(
        "the last metres fit the drawing much less than usual: the drawing is poor here, or the pose is off");
  }
  if (e.position_sigma_m > limits.degraded_sigma_m) {
    return because("the position is uncertain by " + std::to_string(e.position_sigma_m).substr(0, 4) + " m");
  }
  return {LocalizationState::Localized, ""};
}

}  // namespace

LocalizationHealth judge(const HealthEvidence& e, const HealthLimits& limits) {
  HealthEvidence evidence = e;
  if (!e.has_drawing) {  // mapping: nothing to fit to
    evidence.walls_seen = 0.0;
    evidence.inliers = 1.0;
    evidence.fit_nats = limits.verified_nats;
  }
  LocalizationHealth health = lost(evidence, limits);
  if (health.state != LocalizationState::Localized) {
    return health;
  }
  if (evidence.elsewhere_nats > limits.rival_nats) {
    return {LocalizationState::Ambiguous, "another place on the drawing fits as well: drive on slowly"};
  }
  return degraded(evidence, limits);
}

}  // namespace madori::localization
