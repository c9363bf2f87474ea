#include "localization/slam/laid_way.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

Pose carried(const std::vector<ReckonedPose>& way, const WayAnchor& from, std::size_t to) {
  return from.map_from_base * (way[from.index].odom_from_base.inverse() * way[to].odom_from_base);
}

Pose between(const Pose& a, const Pose& b, double share_of_b) {
  const double turn = wrap_angle(b.yaw_rad() - a.yaw_rad());
  return {a.x_m() + share_of_b * (b.x_m() - a.x_m()), a.y_m() + share_of_b * (b.y_m() - a.y_m()),
          a.yaw_rad() + share_of_b * turn};
}

/// Driven from the first moment to each; a vehicle that stands goes on by a micrometre a second.
std::vector<double> driven(const std::vector<ReckonedPose>& way, double radian_m) {
  std::vector<double> sums(way.size(), 0.0);
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Transform2<Base, Base> step = way[i - 1].odom_from_base.inverse() * way[i].odom_from_base;
    const double seconds = std::max(0.0, to_seconds(way[i].stamp - way[i - 1].stamp));
    sums[i] = sums[i - 1] + std::hypot(step.x_m(), step.y_m()) + radian_m * std::abs(step.yaw_rad()) +
              1e-6 * seconds;
  }
  return sums;
}

}  // namespace

std::vector<MomentPose> laid_way(const std::vector<ReckonedPose>& way, const std::vector<WayAnchor>& anchors,
                                 double radian_m) {
  std::vector<MomentPose> laid;
  if (anchors.empty()) return laid;
  const std::vector<double> at = driven(way, radian_m);
  std::size_t next = 0;  // the first anchor that is not before the moment
  for (std::size_t i = 0; i < way.size(); ++i) {
    while (next < anchors.size() && anchors[next].index < i) ++next;
    const WayAnchor& after = anchors[std::min(next, anchors.size() - 1)];
    const WayAnchor& before = next > 0 ? anchors[next - 1] : after;
    const double span = at[after.index] - at[before.index];
    const double share = span > 0.0 ? std::clamp((at[i] - at[before.index]) / span, 0.0, 1.0) : 1.0;
    laid.push_back({way[i].stamp, between(carried(way, before, i), carried(way, after, i), share)});
  }
  return laid;
}

}  // namespace madori::localization
