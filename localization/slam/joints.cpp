#include "localization/slam/joints.hpp"

#include <algorithm>
#include <optional>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/pose_axes.hpp"
#include "localization/slam/stretch.hpp"

namespace madori::localization {
namespace {

/// What the keyframes before `k` and those from `k` on say of each other.
SightCount joint_sights(const Memory& memory, std::size_t k, const JointOptions& options) {
  SightCount sum;
  const auto& keyframes = memory.keyframes();
  const auto& poses = memory.poses();
  const std::size_t end = std::min(memory.size(), k + options.keyframes);
  for (std::size_t j = k; j < end && (j == k || !keyframes[j].cut); ++j) {
    const SightRing ring(*keyframes[j].scan);
    for (std::size_t i = k; i > 0 && k - i < options.keyframes; --i) {
      const std::size_t before = i - 1;
      sum += sights_of_each_other(*keyframes[j].scan, ring, *keyframes[before].scan,
                                  poses[j].inverse() * poses[before]);
      if (keyframes[before].cut) break;
    }
  }
  return sum;
}

/// The share that may contradict: the less of the scan lies on what was seen before, the less.
double most_through(double agreement, double off_wheels, const JointOptions& o) {
  const auto between = [&](double low, double high, double most_low, double most_high) {
    return most_low + std::clamp((agreement - low) / (high - low), 0.0, 1.0) * (most_high - most_low);
  };
  if (agreement < o.doubted_agreement)
    return between(o.no_agreement, o.doubted_agreement, o.most_through_alone, o.most_through_doubted);
  if (off_wheels > kOneInAThousand) return o.most_through_doubted;
  return between(o.doubted_agreement, o.fair_agreement, o.most_through_doubted, o.most_through);
}

/// What neighbours among the keyframes `first` to `last` say of each other: persons, glass, what moved.
double contradiction_among(const Memory& memory, std::size_t first, std::size_t last) {
  SightCount sum;
  for (std::size_t i = first; i < last; ++i)
    sum += sights_of_each_other(*memory.keyframes()[i].scan, *memory.keyframes()[i + 1].scan,
                                memory.poses()[i].inverse() * memory.poses()[i + 1]);
  return sum.contradiction();
}

/// The motion that explains the stretches on both sides of the joint by the wheels' word and what both saw,
/// if one does.
std::optional<RelativeFactor> led_by_wheels(const Memory& memory, std::size_t k, const OdometryStep& wheels,
                                            const JointOptions& options) {
  const StretchOptions stretch;
  Stretch before = stretch_around(memory.keyframes(), k - 1, stretch);
  Stretch after = stretch_around(memory.keyframes(), k, stretch);
  before.last = k - 1;
  after.first = k;
  const StretchMatch led =
      lean_stretches(memory, before, after, wheels.motion, wheels_covariance(wheels, options),
                     memory.poses()[k - 1].inverse() * memory.poses()[k], stretch);
  const double usual = std::max(contradiction_among(memory, before.first, before.last),
                                contradiction_among(memory, after.first, after.last));
  if (led.sights.both() < stretch.least_seen ||
      led.sights.contradiction() > std::min(usual + options.more_through, options.most_through))
    return std::nullopt;
  return led.factor;
}

}  // namespace

Eigen::Matrix3d wheels_covariance(const OdometryStep& wheels, const JointOptions& options) {
  Eigen::Matrix3d covariance = with_floor(wheels.covariance);
  covariance.diagonal().head<2>().array() += options.aside_m * options.aside_m * wheels.turned_rad;
  return covariance;
}

JointVerdict judge_joint(const Memory& memory, std::size_t k, const OdometryStep& wheels, double off_wheels,
                         const JointOptions& options) {
  const auto& keyframes = memory.keyframes();
  if (k == 0 || keyframes[k].cut || keyframes[k].agreement > options.least_agreement) return {};
  const double most = most_through(keyframes[k].agreement, off_wheels, options);
  const SightCount sights = joint_sights(memory, k, options);
  const bool is_known = sights.both() >= options.least_seen;
  if (is_known && sights.contradiction() < most) return {};
  if (!is_known && keyframes[k].agreement > options.no_agreement) return {};
  const bool is_followed =
      k + 1 < memory.size() && !keyframes[k + 1].cut && keyframes[k + 1].agreement < options.least_agreement;
  if (is_followed && joint_sights(memory, k + 1, options).contradiction() > sights.contradiction()) return {};
  if (const auto led = led_by_wheels(memory, k, wheels, options)) return {Joint::Otherwise, *led};
  return {Joint::False, {}};
}

}  // namespace madori::localization
