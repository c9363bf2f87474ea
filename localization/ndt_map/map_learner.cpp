#include "localization/ndt_map/map_learner.hpp"

#include <algorithm>

namespace madori::localization {

bool MapLearner::is_sure(const PoseEstimate& pose) {
  constexpr double kSigmaM = 0.125;  // half a cell
  const double variance_m2 = std::max(pose.covariance(0, 0), pose.covariance(1, 1));
  return pose.health.state == LocalizationState::Localized && variance_m2 < kSigmaM * kSigmaM;
}

bool MapLearner::is_later(Stamp last, Stamp stamp) {
  constexpr double kEveryS = 0.2;
  const double since_s = to_seconds(stamp - last);
  return since_s >= kEveryS || since_s < 0.0;
}

void MapLearner::look(const Beams& beams, const PoseEstimate& pose) {
  last_ = pose.stamp;
  ++looks_;
  map_.look(beams, pose.map_from_base, pose.stamp);
}

}  // namespace madori::localization
