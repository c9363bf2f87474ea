#include "localization/localizer/keyframe_motion.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "localization/localizer/pose_covariance.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {

void KeyframeMotion::add_matched(const Transform2<Base, Base>& motion, const Eigen::Matrix3d& information,
                                 double agreement) {
  agreement_ = std::min(agreement_, agreement);
  motion_ = motion_ * motion;
  information_ = information;
}

void KeyframeMotion::add_unmatched(const Transform2<Base, Base>& motion, double agreement) {
  agreement_ = std::min(agreement_, agreement);
  motion_ = motion_ * motion;
  information_.setZero();
  doubt_ += Eigen::Vector3d(0.04, 0.04, 0.25);
}

MeasuredMotion KeyframeMotion::measured(const Transform2<Map, Base>& map_from_keyframe) const {
  const Eigen::Matrix3d wheels =
      with_floor(wheels_.covariance + Eigen::Matrix3d(doubt_.asDiagonal())).inverse();
  const Eigen::Matrix3d seen = in_map_axes(information_, -map_from_keyframe.yaw_rad());
  return {motion_, seen + wheels, agreement_};
}

}  // namespace madori::localization
