#pragma once

#include <Eigen/Core>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/memory/keyframe.hpp"
#include "localization/motion_model/odometry_model.hpp"

namespace madori::localization {

/// The motion since the newest keyframe, as the scans measured it against the recent keyframes and as the
/// wheels did. A new one for each keyframe.
class KeyframeMotion {
 public:
  /// The small raw motion between two readings of the wheels.
  void extend(const Transform2<Base, Base>& raw, const OdometryModel& model) { model.extend(wheels_, raw); }
  /// A scan that the recent keyframes explain to the share `agreement`, and the motion since the one before;
  /// `information` of (x, y, yaw) at the scan's pose, Map axes.
  void add_matched(const Transform2<Base, Base>& motion, const Eigen::Matrix3d& information,
                   double agreement);
  /// A scan that they do not: what the wheels, or the whole memory, say of it stands in; either may be off.
  void add_unmatched(const Transform2<Base, Base>& motion, double agreement);

  /// Driven, metres.
  [[nodiscard]] double path_m() const { return wheels_.path_m; }
  /// By the wheels alone.
  [[nodiscard]] const OdometryStep& wheels() const { return wheels_; }
  /// In the axes of the keyframe that it started from.
  [[nodiscard]] MeasuredMotion measured(const Transform2<Map, Base>& map_from_keyframe) const;

 private:
  OdometryStep wheels_;
  Eigen::Vector3d doubt_ = Eigen::Vector3d::Zero();        ///< of the motion where no scan confirmed it
  Transform2<Base, Base> motion_;                          ///< by the scans
  double agreement_ = 1.0;                                 ///< the least of the scans
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();  ///< of the last match, Map axes
};

}  // namespace madori::localization
