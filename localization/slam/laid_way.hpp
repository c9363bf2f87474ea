#pragma once

#include <vector>

#include "core/stamp.hpp"
#include "core/transform2.hpp"
#include "localization/slam/mapper.hpp"

namespace madori::localization {

/// A moment of a way that was reckoned step by step and drifts.
struct ReckonedPose {
  Stamp stamp{};
  Transform2<Odom, Base> odom_from_base;
};

/// Where moment `index` of a reckoned way really was.
struct WayAnchor {
  std::size_t index = 0;
  Transform2<Map, Base> map_from_base;
};

/// The reckoned way laid on its anchors (ascending by index): between two of them the error of the reckoning
/// is spread by the way driven, a radian of turn as long as `radian_m`; before the first and after the last
/// it is carried on. Nothing without anchors.
[[nodiscard]] std::vector<MomentPose> laid_way(const std::vector<ReckonedPose>& way,
                                               const std::vector<WayAnchor>& anchors, double radian_m = 0.5);

}  // namespace madori::localization
