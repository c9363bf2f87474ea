#pragma once

#include <Eigen/Core>
#include <memory>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/memory/surface_scan.hpp"

namespace madori::localization {

/// A remembered scan at its pose. The scan never changes: copies of a memory share it.
struct Keyframe {
  std::shared_ptr<const SurfaceScan> scan;
  double path_m = 0.0;       ///< driven since the start
  bool after_break = false;  ///< the motion from its forerunner may be wrong
  double agreement = 1.0;    ///< MeasuredMotion::agreement from its forerunner
  bool cut = false;          ///< no motion leads here from its forerunner: the vehicle was carried here
};

/// A motion with its information, in the axes of the pose it starts from.
struct MeasuredMotion {
  Transform2<Base, Base> motion;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double agreement = 1.0;  ///< share of a scan that lay on what was seen before it, the least on the way
};

}  // namespace madori::localization
