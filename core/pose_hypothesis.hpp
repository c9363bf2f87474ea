#pragma once

#include "core/frames.hpp"
#include "core/transform2.hpp"

namespace madori {

/// A place where the vehicle may be, and how likely among all that are known.
struct PoseHypothesis {
  Transform2<Map, Base> map_from_base;
  double probability = 0.0;  ///< 0..1
  double explained = 0.0;    ///< share of what is seen that lies on drawn walls there, 0..1
};

/// How far a pose that a person gave may be off, one sigma.
struct PoseSigma {
  double position_m = 0.3;
  double yaw_rad = 0.17453292519943295;  ///< 10 deg

  friend bool operator==(const PoseSigma&, const PoseSigma&) = default;
};

}  // namespace madori
