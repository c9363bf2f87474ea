#pragma once

#include <optional>
#include <vector>

#include "core/pose_estimate.hpp"
#include "core/pose_hypothesis.hpp"
#include "localization/global/global_localizer.hpp"

namespace madori::localization {

/// What a scan said of a place that is sought: the place, once it is sure, or else how the search stands.
struct Sighting {
  std::optional<RegistrationResult> found;
  LocalizationHealth health;  ///< while nothing is found
};

/// The search for the place while it is not known, scan after scan: what one scan leaves ambiguous, a few
/// resolve, and a place is sure once a few answers in a row agree. Where a person gave a pose, the next scan
/// alone says whether the vehicle is near it. Deterministic, causal.
class PlaceSearch {
 public:
  /// So many answers in a row must agree.
  explicit PlaceSearch(int sightings_to_start) : sightings_to_start_(sightings_to_start) {}

  /// Begins anew, from what is known of the newest scan; a pose that was given is forgotten.
  void restart(std::optional<GlobalAnswer> known = std::nullopt);
  /// A person says where the vehicle stands, so exactly.
  void give(const PoseSigma& sigma) { given_ = sigma; }
  /// Whether a given pose still waits for its scan.
  [[nodiscard]] bool is_given() const { return given_.has_value(); }
  /// A scan (Base frame), the motion since the one before, and the pose at the scan that was given, if any.
  [[nodiscard]] Sighting observe(const ScanPoints& points, const Transform2<Base, Base>& moved,
                                 const Transform2<Map, Base>& given, const GlobalLocalizer& global);
  /// Where the vehicle may be, likeliest first, `moved` after the newest scan.
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses(const Transform2<Base, Base>& moved) const;

 private:
  [[nodiscard]] Sighting check(const ScanPoints& points, const Transform2<Map, Base>& given,
                               const GlobalLocalizer& global);

  int sightings_to_start_;
  std::optional<GlobalAnswer> answer_;  ///< of the newest scan
  int agreeing_ = 0;
  std::optional<PoseSigma> given_;
};

}  // namespace madori::localization
