#pragma once

#include <cstddef>

#include "localization/memory/memory.hpp"
#include "localization/memory/sights.hpp"
#include "localization/motion_model/odometry_model.hpp"

namespace madori::localization {

struct JointOptions {
  std::size_t keyframes = 3;  ///< on either side of a joint that are asked
  int least_seen = 40;        ///< points that both sides must have had in view
  /// Share of them that may contradict, by the share of the scan that lies on what was seen before it, and in
  /// proportion between. Chosen on Intel and ACES, whole and cut ten times in four orders, all scans, every
  /// second and every fifth, and on FR079 and ACES cut once more each.
  double most_through = 0.3;
  double fair_agreement = 0.45;
  double most_through_doubted = 0.12;  ///< the same where the scans lead off the wheels,
  double doubted_agreement = 0.3;
  double most_through_alone = 0.07;  ///< and where a scan lies on nothing
  double no_agreement = 0.15;        ///< no neighbour is near by chance alone, either
  double more_through = 0.1;         ///< where the wheels lead: than on either side among neighbours
  double aside_m = 0.05;             ///< sigma of the place about which it turns, a root-radian
  double least_agreement = 0.55;     ///< of the scan: no joint is doubted
};

enum class Joint {
  Holds,
  Otherwise,  ///< another motion explains what was seen
  False,      ///< the vehicle was carried away
};

struct JointVerdict {
  Joint joint = Joint::Holds;
  RelativeFactor motion;  ///< that explains it, where it is another
};

/// Of the wheels' word at a joint (x, y, yaw, axes of its start): more than the odometry's own, for no
/// vehicle turns about exactly the place that is its Base.
[[nodiscard]] Eigen::Matrix3d wheels_covariance(const OdometryStep& wheels, const JointOptions& options);

/// Was the vehicle carried away before keyframe `k`? It was where the scans on both sides, laid on each other
/// as well as they could be, see through each other's walls, and do so, too, where the wheels lead and what
/// little they saw of the same pulls. `wheels`: their word from the keyframe before; `off_wheels`: sigmas
/// squared by which the scans led off it. Of joints that follow each other the worst is meant: the others are
/// judged by the same scans.
[[nodiscard]] JointVerdict judge_joint(const Memory& memory, std::size_t k, const OdometryStep& wheels,
                                       double off_wheels, const JointOptions& options = {});

}  // namespace madori::localization
