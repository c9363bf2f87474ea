#include "localization/slam/joints.hpp"

#include <algorithm>

namespace madori::localization {
namespace {

/// A scan that lies on less than this of what was seen before is where it is by the wheels' word alone.
constexpr double kUnmatched = 0.35;
constexpr double kOnNothing = 0.15;  // no neighbour is near by chance alone, either

}  // namespace

SightCount joint_sights(const Memory& memory, std::size_t k, const JointOptions& options) {
  SightCount sum;
  const auto& keyframes = memory.keyframes();
  const auto& poses = memory.poses();
  const std::size_t end = std::min(memory.size(), k + options.keyframes);
  for (std::size_t j = k; j < end && (j == k || !keyframes[j].cut); ++j) {
    const SightRing ring(*keyframes[j].scan);
    for (std::size_t i = k; i > 0 && k - i < options.keyframes; --i) {
      const std::size_t before = i - 1;
      const auto motion = poses[j].inverse() * poses[before];
      sum += ring.of(*keyframes[before].scan, motion);
      sum += SightRing(*keyframes[before].scan).of(*keyframes[j].scan, motion.inverse());
      if (keyframes[before].cut) break;
    }
  }
  return sum;
}

bool is_false_joint(const Memory& memory, std::size_t k, double off_wheels, const JointOptions& options) {
  const auto& keyframes = memory.keyframes();
  if (k == 0 || keyframes[k].cut || keyframes[k].agreement > options.least_agreement) return false;
  const SightCount sights = joint_sights(memory, k, options);
  const bool is_doubted = off_wheels > options.off_wheels || keyframes[k].agreement < kUnmatched;
  const bool has_to_be_vouched_for = keyframes[k].agreement < kOnNothing;
  if (sights.both() < options.least_seen) return has_to_be_vouched_for;
  const double most = has_to_be_vouched_for ? options.most_through_alone
                      : is_doubted          ? options.most_through_off
                                            : options.most_through;
  if (sights.contradiction() < most) return false;
  const bool is_followed =
      k + 1 < memory.size() && !keyframes[k + 1].cut && keyframes[k + 1].agreement < options.least_agreement;
  return !is_followed || joint_sights(memory, k + 1, options).contradiction() < sights.contradiction();
}

}  // namespace madori::localization
