#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "localization/landmarks/landmark_map.hpp"

namespace madori::localization::landmarks {

/// The central entity: one map that all agents report to. Calls come one after the other.
class LandmarkHub {
 public:
  static constexpr int kCapacity = NodeSet::kMost;
  using Map = LandmarkMap<kCapacity>;

  /// `most_landmarks` up to kCapacity - 1: the reductions need a free place.
  explicit LandmarkHub(int most_landmarks = 60);

  [[nodiscard]] const Map& map() const { return *map_; }
  [[nodiscard]] bool full() const { return map_->size() >= most_landmarks_; }
  [[nodiscard]] FullPose landmark(int i) const;
  /// All landmarks seen from one of them: what is near it is known better than the same from the origin.
  [[nodiscard]] std::vector<FullPose> seen_from(int landmark) const;

  /// The number of a new landmark. The first is the origin.
  int add(const Descriptor& descriptor) { return map_->add(descriptor); }
  /// An agent's measurement between two landmarks, Eq. (17).
  void measure(int from, int to, const FullPose& edge);
  /// Measurements taken in so far, also those of pairs that had one.
  [[nodiscard]] int measurements() const { return measurements_; }

 private:
  int most_landmarks_;
  int measurements_ = 0;
  std::unique_ptr<Map> map_;
};

/// The landmarks by the published scalar form, on the same measurements: what a controller without the full
/// form would say.
[[nodiscard]] std::vector<ScalarPose> published_landmarks(const LandmarkHub& hub);

/// Where to go to become sure again: among the landmarks that edges lead to from `from`, the one of least
/// position variance that is surer than `variance_m2`; nothing where there is none. "Return to landmarks with
/// little to no uncertainty", section II.C.
[[nodiscard]] std::optional<int> surer_landmark(const LandmarkHub& hub, int from, double variance_m2);

/// sqrt of the mean variance of the two axes: the published U_D.
[[nodiscard]] double position_sigma_m(const FullUncertainty& uncertainty);

}  // namespace madori::localization::landmarks
