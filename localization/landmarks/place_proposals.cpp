#include "localization/landmarks/place_proposals.hpp"

#include <algorithm>
#include <cmath>

#include "localization/landmarks/bare_math.hpp"

namespace madori::localization::landmarks {
namespace {

constexpr double kShareOfRange =
    0.005;  ///< no match is better than this share of the descriptor's median range,
constexpr double kLeastSigma_rad = 0.0026;  ///< nor than 0.15 degrees, as in the memory's pose graph
constexpr double kLeastQuality = 0.75;      ///< of a match where nothing else speaks for the place

}  // namespace

DescriptorMatch match_landmark(const Descriptor& landmark, const Surroundings& seen,
                               const MatchWindow& window) {
  // Whoever stands farther away than it is wide sees another place; the starts grow with the square of that.
  const double reach_m = std::min(window.reach_m, 2.0 * landmark.median_range_m());
  DescriptorMatch match =
      match_descriptor(landmark, seen.descriptor, {window.centre, reach_m, window.reach_rad});
  const double floor_m2 = std::pow(kShareOfRange * landmark.median_range_m(), 2);
  match.uncertainty.covariance =
      match.uncertainty.covariance + Matrix3::diagonal(floor_m2, floor_m2, kLeastSigma_rad * kLeastSigma_rad);
  return match;
}

std::optional<DescriptorMatch> recognise_anywhere(const Descriptor& landmark, const Surroundings& seen) {
  const DescriptorMatch match = match_landmark(landmark, seen, {{}, seen.corridor_width_m, kHalfTurn_rad});
  return match.quality < kLeastQuality ? std::nullopt : std::optional(match);
}

std::vector<PlaceProposal> propose_places(const LandmarkHub& hub, const Surroundings& seen) {
  std::vector<PlaceProposal> proposals;
  for (int i = 0; i < hub.map().size(); ++i) {
    const FullPose landmark = hub.landmark(i);
    if (landmark.uncertainty.is_unknown()) continue;
    const auto match = recognise_anywhere(hub.map().descriptor(i), seen);
    if (match)
      proposals.push_back({i, *match, added(landmark, {match->landmark_from_scan, match->uncertainty})});
  }
  std::sort(proposals.begin(), proposals.end(),
            [](const auto& a, const auto& b) { return a.match.quality > b.match.quality; });
  return proposals;
}

}  // namespace madori::localization::landmarks
