#pragma once

#include <cstddef>

#include "localization/memory/memory.hpp"
#include "localization/memory/sights.hpp"

namespace madori::localization {

struct JointOptions {
  std::size_t keyframes = 3;         ///< on either side of a joint that are asked
  int least_seen = 40;               ///< points that both sides must have had in view
  double most_through = 0.3;         ///< share of them that may contradict,
  double most_through_off = 0.15;    ///< the same where the scans lead off the wheels,
  double most_through_alone = 0.07;  ///< and where a scan lies on nothing: the sights alone vouch for it,
  double off_wheels = 16.3;          ///< sigmas squared: chi-squared of three, one in a thousand,
  double least_agreement = 0.55;     ///< unless this share of the scan lies on what was seen before it
};

/// What the keyframes before `k` and those from `k` on say of each other.
[[nodiscard]] SightCount joint_sights(const Memory& memory, std::size_t k, const JointOptions& options = {});

/// Whether the vehicle was carried away before keyframe `k`: scans on both sides of it were laid on each
/// other as well as they could, and see through each other's walls all the same. `off_wheels`: sigmas squared
/// by which the scans led off the wheels' word there. Of joints that follow each other the worst is meant:
/// the others are judged by the same scans.
[[nodiscard]] bool is_false_joint(const Memory& memory, std::size_t k, double off_wheels,
                                  const JointOptions& options = {});

}  // namespace madori::localization
