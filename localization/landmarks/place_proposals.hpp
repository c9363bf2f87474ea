#pragma once

#include <optional>
#include <vector>

#include "localization/landmarks/landmark_hub.hpp"
#include "localization/landmarks/surroundings.hpp"

namespace madori::localization::landmarks {

/// "The crossing seen before": a pose that a scan alone suggests, without any idea of where the vehicle is.
struct PlaceProposal {
  int landmark = 0;
  DescriptorMatch match;
  FullPose pose;  ///< of the vehicle, seen from landmark 0, with the landmark's own uncertainty
};

/// The scan compared with all landmarks, any heading, up to a corridor's width away; the best fitting first.
/// Empty where nothing fits. Several may: crossings look alike, and whoever uses them must weigh them.
[[nodiscard]] std::vector<PlaceProposal> propose_places(const LandmarkHub& hub, const Surroundings& seen);

/// Matches a scan with one landmark; the uncertainty has the floor that no match is better than.
[[nodiscard]] DescriptorMatch match_landmark(const Descriptor& landmark, const Surroundings& seen,
                                             const MatchWindow& window);

/// Is this the landmark, nothing else speaking for it? Any heading, up to a corridor's width away.
[[nodiscard]] std::optional<DescriptorMatch> recognise_anywhere(const Descriptor& landmark,
                                                                const Surroundings& seen);

}  // namespace madori::localization::landmarks
